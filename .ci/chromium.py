"""Opens pages of `tabletop report` in headless Chromium, plays them with keys and clicks, and fails on any error in its console."""

import base64
import json
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time
import urllib.request


class Browser:
    """A page, driven by Chromium's DevTools protocol over a WebSocket."""

    def __init__(self, program: str, profile: str) -> None:
        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0", "--no-first-run",
             "--disable-background-networking", f"--user-data-dir={profile}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        port_file = pathlib.Path(profile) / "DevToolsActivePort"
        deadline = time.monotonic() + 60
        while not (port_file.exists() and port_file.read_text().count("\n")):
            if time.monotonic() > deadline:
                raise RuntimeError("Chromium does not start")
            time.sleep(0.1)
        port = int(port_file.read_text().split()[0])
        pages = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
        address = next(page["webSocketDebuggerUrl"] for page in pages if page["type"] == "page")
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        path = address.split(str(port), 1)[1]
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self.received = b""
        while b"\r\n\r\n" not in self.received:
            self.received += self.socket.recv(4096)
        self.received = self.received.split(b"\r\n\r\n", 1)[1]
        self.number = 0
        self.errors: list[str] = []
        self.addresses: list[str] = []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def take(self, count: int) -> bytes:
        while len(self.received) < count:
            more = self.socket.recv(1 << 20)
            if not more:
                raise RuntimeError("Chromium has closed the connection")
            self.received += more
        taken, self.received = self.received[:count], self.received[count:]
        return taken

    def message(self) -> dict:
        whole = b""
        while True:
            first, length = self.take(2)
            length &= 0x7F
            if length == 126:
                (length,) = struct.unpack(">H", self.take(2))
            elif length == 127:
                (length,) = struct.unpack(">Q", self.take(8))
            whole += self.take(length)
            if first & 0x80:
                return json.loads(whole)

    def note(self, event: dict) -> None:
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(str(params["exceptionDetails"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.errors.append(params["entry"]["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.errors.append(str(params["args"]))
        elif method == "Network.requestWillBeSent":
            self.addresses.append(params["request"]["url"][:60])

    def call(self, method: str, **params: object) -> dict:
        self.number += 1
        data = json.dumps({"id": self.number, "method": method, "params": params}).encode()
        length = len(data)
        head = bytes([0x81, 0x80 | length]) if length < 126 else bytes([0x81, 0xFE]) + struct.pack(">H", length)
        # The mask is zero: it protects proxies, of which there are none.
        self.socket.sendall(head + bytes(4) + data)
        while True:
            message = self.message()
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.note(message)

    def value(self, expression: str) -> object:
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def press(self, key: str, code: int, text: str = "") -> None:
        for kind in ("keyDown", "keyUp"):
            more = {"text": text} if text and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, **more)

    def open(self, page: pathlib.Path) -> None:
        self.call("Page.navigate", url=page.resolve().as_uri())
        self.wait("document.readyState === 'complete' && location.protocol === 'file:'")

    def wait(self, expression: str) -> None:
        deadline = time.monotonic() + 20
        while not self.value(expression):
            if time.monotonic() > deadline:
                raise AssertionError(f"it did not come to this in 20 s: {expression}")
            time.sleep(0.05)


def frame(browser: Browser) -> int:
    return int(browser.value("document.getElementById('slider').value"))


def expect(is_true: bool, words: str) -> None:
    if not is_true:
        raise AssertionError(words)


def play(browser: Browser) -> None:
    last = int(browser.value("document.getElementById('slider').max"))
    browser.wait("document.getElementById('picture').naturalWidth > 0")
    browser.press(" ", 32, " ")
    browser.wait("Number(document.getElementById('slider').value) >= 2")
    browser.press(" ", 32, " ")
    paused = frame(browser)
    time.sleep(0.6)
    expect(frame(browser) == paused, "it plays on after a pause")
    browser.press("Home", 36)
    expect(frame(browser) == 0, "Home does not go to the beginning")
    first = browser.value("document.getElementById('picture').src")
    browser.press("ArrowRight", 39)
    expect(frame(browser) == 1, "the arrow does not go a frame on")
    browser.press("End", 35)
    expect(frame(browser) == last, "End does not go to the end")
    expect(browser.value("document.getElementById('picture').src") != first, "the picture stays the same")
    browser.value("document.querySelector('.deeds button, .segment').click()")
    expect(frame(browser) < last, "a click on a sentence does not go to its moment")
    reached = set()
    browser.value("document.activeElement.blur()")
    for _ in range(browser.value("document.querySelectorAll('button, input, select').length") + 5):
        browser.press("Tab", 9)
        reached.add(browser.value("document.activeElement.id || document.activeElement.className || document.activeElement.textContent"))
    for name in ("play", "slider", "speed", "first", "last", "thumbnail", "segment"):
        expect(name in reached, f"Tab does not reach {name}: {reached}")


def main() -> None:
    program = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if program is None:
        sys.exit("there is no Chromium here")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            for name in sys.argv[1:]:
                browser.open(pathlib.Path(name))
                if browser.value("document.getElementById('slider') !== null"):
                    play(browser)
                else:
                    expect(browser.value("document.querySelectorAll('img.small').length") > 0, "the table has no pictures")
                foreign = [it for it in browser.addresses if not it.startswith(("file:", "data:"))]
                expect(not foreign, f"it asks the network: {foreign}")
                expect(not browser.errors, f"errors in the console: {browser.errors}")
                print(f"{pathlib.Path(name).name}: fine")
        finally:
            browser.process.kill()
            browser.process.wait()


main()
