"""Server on this machine in place of one of published containers."""

import contextlib
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

#: First line of an answer, with the end of its head.
OK = b"HTTP/1.0 200 OK\r\n\r\n"


@contextlib.contextmanager
def server(send):
    """Server whose answers a function sends, and the address of a page."""

    class Answer(BaseHTTPRequestHandler):
        def do_GET(self):  # noqa: N802
            with contextlib.suppress(OSError):
                send(self)

        def log_message(self, *_):
            pass

    serving = ThreadingHTTPServer(("127.0.0.1", 0), Answer)
    threading.Thread(target=serving.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{serving.server_port}/go/abc"
    finally:
        serving.shutdown()
        serving.server_close()


def page(request):
    """Send the page of a publication, which names its container. True if this was asked for."""
    if request.path != "/go/abc":
        return False
    address = f"http://127.0.0.1:{request.server.server_port}/file.zip"
    request.wfile.write(OK + json.dumps({"download_url": address}).encode())
    return True
