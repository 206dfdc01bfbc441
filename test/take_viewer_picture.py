#!/usr/bin/env python3
"""Take the picture of the viewer's page for the docs, in a real browser without a window.

    python test/take_viewer_picture.py [docs/images/viewer.png]

Runs the suite with the twin and the page, follows the lemniscate for a while, and takes the picture at a moment when
no node complains (software rendering takes the processors away from the loops now and then).
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "src" / "gaik_ros" / "test"))  # where the tests of the page have their browser

from headless_browser import BrowserPage, browser_page  # noqa: E402

FOLLOW = 30.0  # s: fills the plot of the error
PATIENCE = 120.0  # s
CLOSE_NOTICES = "document.querySelectorAll('.mantine-Notification-closeButton').forEach(b => b.click())"


def take(page: BrowserPage, address: str, file: Path) -> None:
    """Open the page, start the path and take the picture. TimeoutError: no good moment comes."""
    page.open(address)
    wait_until(page, lambda text: "Hz" in text)
    page.click_on("Lemniscate")
    time.sleep(FOLLOW)
    page.evaluate(CLOSE_NOTICES)
    file.parent.mkdir(parents=True, exist_ok=True)
    while True:
        wait_until(page, content)
        page.screenshot(file)
        if content(page.text()):  # still
            return


def content(text: str) -> bool:
    """Whether no node complains."""
    return "Hz" in text and "runs at" not in text and "percentile" not in text


def wait_until(page: BrowserPage, shown) -> None:
    """Wait until the page shows what is wanted."""
    end = time.monotonic() + PATIENCE
    while not shown(page.text()):
        if time.monotonic() > end:
            raise TimeoutError("the nodes complain all the time: this machine is too busy")
        time.sleep(0.05)


def main() -> int:
    """Run the suite and take the picture."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "docs" / "images" / "viewer.png")
    file = parser.parse_args().file
    environment = os.environ | {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    # Software rendering takes processors; the loops go first, where that is allowed (otherwise `nice` only says so).
    command = ["nice", "-n", "-15", sys.executable, "-m", "touch_sim.view", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as suite:
        try:
            address = suite.stdout.readline().split("at ")[1].split(";")[0]
            with browser_page(1440, 900) as page:
                take(page, address, file)
        except TimeoutError as reason:
            print(f"take_viewer_picture: {reason}", file=sys.stderr)
            return 1
        finally:
            suite.terminate()
    print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
