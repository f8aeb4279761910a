"""Content of a container of published scans: of a file, or behind a DOI or the address of a page."""

import re
import threading
from pathlib import Path

from stiction.command.launch import RefusedError
from stiction.regular_files import require_regular

#: A DOI, and what is in front of it in an address.
_DOI, _RESOLVER = re.compile(r"10\.\d{4,9}/\S+"), "https://doi.org/"
#: ASSUME: containers of contact.engineering have up to some hundred MB, their pages some kB; a slow network needs
#: minutes [MiB, MiB, s].
LARGEST, LARGEST_PAGE, LONGEST = 1000, 1, 900
#: Time in which a server must answer or send more [s], size of the chunks that are read, and of a MiB [bytes].
_SILENCE, _CHUNK, _MIB = 60, 2**16, 2**20


def content(source: str) -> bytes:
    """Read a container from a file, or fetch it.

    Raises
    ------
    RefusedError
        If there is no such container, it is too large, or it takes too long.
    """
    path = Path(source)
    if "\0" not in source and path.exists():
        return _stored(path)
    return _in_time(_address(source), source)


def _stored(path):
    """Content of a file."""
    try:
        require_regular(path)
        if path.stat().st_size > LARGEST * _MIB:
            raise RefusedError(f"{path} has more than {LARGEST:g} MiB: give a smaller container")
        return path.read_bytes()
    except OSError as reason:
        raise RefusedError(f"{path} cannot be read: {reason.strerror}") from None


def _address(source):
    """Address of the page of a published container."""
    if _DOI.fullmatch(source):
        return _RESOLVER + source
    if source.startswith(("https://", "http://")):
        return source
    raise RefusedError(f"{source} does not exist; give a container file, a DOI, or the address of its page")


def _in_time(address, source):
    """Fetch a container by a thread of its own, because no library limits the time of a whole answer."""
    ended = {}

    def fetch():
        """Keep the content, or the error."""
        try:
            ended["content"] = _fetched(address)
        except Exception as reason:  # whatever a network or a server causes
            ended["reason"] = reason

    thread = threading.Thread(target=fetch, daemon=True)
    thread.start()
    thread.join(LONGEST)
    if "content" in ended:
        return ended["content"]
    if isinstance(reason := ended.get("reason"), RefusedError):
        raise reason
    why = type(reason).__name__ if reason else f"it takes more than {LONGEST:g} s"
    raise RefusedError(f"{source} cannot be fetched ({why}): download it, and give the file")


def _fetched(address):
    """Container behind the page of a publication. Its page names the container if asked for JSON."""
    import json

    page = json.loads(_answer(address, LARGEST_PAGE, {"Accept": "application/json"}))
    return _answer(str(page["download_url"]), LARGEST, {})


def _answer(address, largest, headers):
    """Answer of a server, of at most some MiB."""
    import requests  # takes longer than all other imports

    with requests.get(address, headers=headers, stream=True, timeout=_SILENCE) as response:
        response.raise_for_status()
        received = bytearray()
        for block in response.iter_content(_CHUNK):
            received += block
            if len(received) > largest * _MIB:
                raise RefusedError(f"{address} sends more than {largest:g} MiB: give a smaller container")
    return bytes(received)
