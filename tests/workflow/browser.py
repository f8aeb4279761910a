"""A headless browser, driven by WebDriver over HTTP."""

import contextlib
import json
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request
from importlib import resources
from itertools import product

import numpy as np

from stiction.answer.data import Probability
from stiction.report.answer import words

#: Names of the browser on different systems.
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--window-size=1500,1000"]
FLAGS += ["--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"]
#: [s]
PATIENCE = 60
#: Key of an element in the answers of WebDriver.
_ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


def says_fraction(text, fraction, band, beyond=0):
    """Whether a text ends in a fraction with its band as an answer says it, or in the end of it that alone is known.

    All are between 0 and 1; ``beyond`` is -1 or 1 where only the upper or lower end is known. The numbers of a page
    have seven digits, which a steep curve makes an error of a thousandth.
    """
    factors = product((1, 1 - 1e-3, 1 + 1e-3), repeat=3)
    near = (np.minimum(1, np.array([fraction, *band]) * some) for some in factors)
    return any(text.rpartition(": ")[2] == _said(*some, beyond) for some in near)


def _said(fraction, low, high, beyond):
    """P(stuck) in the words of an answer."""
    if beyond > 0 and low <= 1 - 1e-3:
        return f"at least {words.percent(low, 'low')}"
    return words.stuck_in_words(Probability(fraction, low, high, none_seen=beyond < 0))


def missing():
    """What is not installed, as a reason to skip a test; empty if nothing is missing."""
    if not shutil.which("chromedriver"):
        return "chromedriver is not installed: apt-get install chromium-driver"
    if not any(map(shutil.which, NAMES)):
        return "Chromium is not installed: apt-get install chromium"
    return ""


class Browser:
    """One tab of a headless Chromium; a context that ends the browser and removes its files."""

    def __enter__(self):
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="browser-", ignore_cleanup_errors=True))
            driver = subprocess.Popen(
                [shutil.which("chromedriver"), "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
            )
            stack.callback(driver.stdout.close)
            stack.callback(driver.wait)
            stack.callback(driver.terminate)
            line = next(line for line in driver.stdout if "successfully" in line)
            self.url = f"http://127.0.0.1:{line.rstrip().rstrip('.').rpartition(' ')[2]}/session"
            options = {
                "binary": next(filter(None, map(shutil.which, NAMES))),
                "args": [*FLAGS, f"--user-data-dir={folder}"],
            }
            wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
            self.url += f"/{self.send('POST', '', capabilities={'alwaysMatch': wanted})['sessionId']}"
            stack.callback(self.send, "DELETE", "")
            self.stack = stack.pop_all()
        return self

    def __exit__(self, *_):
        self.stack.close()

    def send(self, method, path, **body):
        """Value of the answer to a command of WebDriver."""
        content = json.dumps(body).encode() if method == "POST" else None
        request = urllib.request.Request(self.url + path, content, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=2 * PATIENCE) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from error

    def open(self, path):
        """Open a file."""
        self.send("POST", "/url", url=path.resolve().as_uri())

    def resize(self, width, height=900):
        """Pretend that the screen has a size, also below the smallest one of a window."""
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.send("POST", "/goog/cdp/execute", cmd="Emulation.setDeviceMetricsOverride", params=screen)

    def run(self, script, *arguments):
        """Result of the body of a JavaScript function."""
        return self.send("POST", "/execute/sync", script=script, args=arguments)

    def find(self, css):
        """Elements that a CSS selector matches."""
        return [found[_ELEMENT] for found in self.send("POST", "/elements", using="css selector", value=css)]

    def text(self, element):
        """Text of an element as it is shown."""
        return self.send("GET", f"/element/{element}/text")

    def click(self, element):
        """Click an element, which must be visible."""
        self.send("POST", f"/element/{element}/click")

    def touch(self, element, start, end):
        """Put a finger on a part of the width of an element, move it to another part, and lift it."""
        where = "const e = arguments[0]; e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect();"
        left, middle, width = self.run(f"{where} return [r.left, r.top + r.height / 2, r.width]", {_ELEMENT: element})
        first, last = (
            {"type": "pointerMove", "duration": 50, "x": round(left + part * width), "y": round(middle)}
            for part in (start, end)
        )
        steps = [first, {"type": "pointerDown", "button": 0}, last, {"type": "pointerUp", "button": 0}]
        finger = {"type": "pointer", "id": "finger", "parameters": {"pointerType": "touch"}, "actions": steps}
        self.send("POST", "/actions", actions=[finger])

    def inside(self, css, script):
        """Result of JavaScript inside a frame."""
        (frame,) = self.find(css)
        self.send("POST", "/frame", id={_ELEMENT: frame})
        try:
            return self.run(script)
        finally:
            self.send("POST", "/frame/parent")

    def wait(self, condition, patience=PATIENCE):
        """First true value of a condition; the last value once patience [s] ends."""
        end = time.monotonic() + patience
        while not (found := condition()) and time.monotonic() < end:
            time.sleep(0.05)
        return found

    def violations(self):
        """Violations of accessibility that axe finds on the page: rule, number of elements, and the first of them."""
        self.run((resources.files("axe_core_python") / "axe.min.js").read_text(encoding="utf-8"))
        script = "const done = arguments[0]; axe.run(document).then(({violations}) => done(violations))"
        found = self.send("POST", "/execute/async", script=script, args=[])
        return [(one["id"], len(one["nodes"]), one["nodes"][0]["html"]) for one in found]

    def errors(self):
        """Errors in the console since the last call."""
        entries = self.send("POST", "/se/log", type="browser")
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]
