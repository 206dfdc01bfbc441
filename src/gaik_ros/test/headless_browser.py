"""A real Chromium without a window, driven over its DevTools protocol: pages, mouse, screenshots."""

from __future__ import annotations

import base64
import contextlib
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

NAMES = ("chromium", "chromium-browser", "google-chrome")
MISSING = "no browser; install one with: sudo apt-get install chromium"
PATIENCE = 60.0  # s; for a start on a busy machine
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
)
# Drawn by the processor: a frame every 80 ms leaves some of it to the nodes.
FEW_FRAMES = (
    "const drawn = window.requestAnimationFrame.bind(window);"
    "window.requestAnimationFrame = draw => setTimeout(() => drawn(draw), 80);"
    "window.cancelAnimationFrame = clearTimeout;"
)


def browser_path() -> str | None:
    """The browser that is installed, None where none is."""
    return next(filter(None, map(shutil.which, NAMES)), None)


class BrowserPage:
    """One page of a running browser."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._sent = 0
        self.complaints: list[str] = []  # what the page's scripts threw
        self.call("Runtime.enable")
        self.call("Page.enable")
        self.call("Page.addScriptToEvaluateOnNewDocument", source=FEW_FRAMES)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command of the DevTools protocol and return its result."""
        self._sent += 1
        self._socket.send(json.dumps({"id": self._sent, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=PATIENCE))
            if answer.get("method") == "Runtime.exceptionThrown":
                self.complaints.append(answer["params"]["exceptionDetails"]["text"])
            if answer.get("id") == self._sent:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def open(self, address: str) -> None:
        """Go to an address."""
        self.call("Page.navigate", url=address)

    def evaluate(self, expression: str) -> Any:
        """The value of a JavaScript expression in the page."""
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def text(self) -> str:
        """All text that is shown."""
        return self.evaluate("document.body ? document.body.innerText : ''") or ""

    def mouse(self, kind: str, x: float, y: float) -> None:
        """A mouse event: mousePressed, mouseMoved or mouseReleased, at a place in pixels."""
        held = kind != "mouseReleased"
        self.call(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button="left",
            buttons=1 if held else 0,
            clickCount=0 if kind == "mouseMoved" else 1,
        )

    def hover(self, x: float, y: float) -> None:
        """Move the mouse with no button held."""
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="none", buttons=0)

    def click(self, x: float, y: float) -> None:
        """Press and release at a place."""
        self.hover(x, y)
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def click_on(self, label: str) -> None:
        """Click the button of that label."""
        place = self.evaluate(
            "(() => { const b = [...document.querySelectorAll('button')]"
            f".find(b => b.innerText.trim() === {json.dumps(label)});"
            " if (!b) return null; b.scrollIntoView(); const r = b.getBoundingClientRect();"
            " return [r.x + r.width / 2, r.y + r.height / 2] })()"
        )
        if place is None:
            raise LookupError(f"no button {label!r}")
        self.click(*place)

    def drag(self, start: tuple[float, float], end: tuple[float, float], steps: int = 20) -> None:
        """Drag with the left button from one place to another, over about a second."""
        self.hover(*start)
        time.sleep(0.3)  # the page looks under the mouse at its own pace
        self.mouse("mousePressed", *start)
        for step in range(1, steps + 1):
            part = step / steps
            self.mouse(
                "mouseMoved", start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1])
            )
            time.sleep(0.04)
        self.mouse("mouseReleased", *end)

    def screenshot(self, file: Path) -> None:
        """Save what is seen as PNG."""
        file.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))


@contextlib.contextmanager
def browser_page(width: int, height: int, scale: float = 1.0) -> Iterator[BrowserPage]:
    """Run the browser with an empty profile and one empty page, and end it. RuntimeError: it does not start.

    `width` and `height` are in the page's own pixels, each of which is `scale` pixels wide that are drawn.
    """
    from websockets.sync.client import connect  # comes with viser, without which there is no page

    path = browser_path()
    if path is None:
        raise RuntimeError(MISSING)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [
            path,
            *FLAGS,
            f"--user-data-dir={profile}",
            f"--window-size={width},{height}",
            "about:blank",
        ]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            with connect(_page_socket(Path(profile), process), max_size=None) as socket:
                page = BrowserPage(socket)
                page.call(
                    "Emulation.setDeviceMetricsOverride",
                    width=width,
                    height=height,
                    deviceScaleFactor=scale,
                    mobile=False,
                )
                yield page
        finally:
            process.terminate()
            try:
                process.wait(10.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _page_socket(profile: Path, process: subprocess.Popen[bytes]) -> str:
    """The address of the page's WebSocket, once the browser has said its port."""
    end, said = time.monotonic() + PATIENCE, profile / "DevToolsActivePort"
    while time.monotonic() < end and process.poll() is None:
        with contextlib.suppress(OSError, ValueError, StopIteration):
            port = int(said.read_text().split()[0])
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list", timeout=5.0) as response:
                targets = json.load(response)
            return str(next(t for t in targets if t["type"] == "page")["webSocketDebuggerUrl"])
        time.sleep(0.05)
    raise RuntimeError(f"the browser did not start (exit code {process.poll()})")
