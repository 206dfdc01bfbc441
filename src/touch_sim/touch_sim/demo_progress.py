"""How far the demo is: a bar on a terminal, a line for each path elsewhere."""

from __future__ import annotations

from typing import TextIO

from touch_sim.demo_run import Progress


def progress_for(stream: TextIO) -> Progress:
    """Return what suits `stream`."""
    return Bar(stream) if stream.isatty() else Lines(stream)


class Bar:
    """One bar for each path, by tqdm."""

    def __init__(self, stream: TextIO) -> None:
        from tqdm import tqdm

        tqdm.monitor_interval = 0  # no thread of its own beside the loops
        self._tqdm, self._stream = tqdm, stream

    def begin(self, name: str, setpoints: int) -> None:
        """Show an empty bar."""
        self._bar = self._tqdm(total=setpoints, desc=f"{name:<10}", unit=" setpoints", file=self._stream)

    def advance(self, setpoints: int) -> None:
        """Fill it to the setpoints sent in all."""
        self._bar.update(min(setpoints, self._bar.total) - self._bar.n)

    def end(self) -> None:
        """Leave it as it is."""
        self._bar.close()


class Lines:
    """A line when a path begins."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def begin(self, name: str, setpoints: int) -> None:
        """Say it."""
        print(f"following the {name}: {setpoints} setpoints", file=self._stream, flush=True)

    def advance(self, setpoints: int) -> None:
        """Say nothing."""

    def end(self) -> None:
        """Say nothing."""


class Silent:
    """Nothing at all, for a run inside something that has a progress of its own."""

    def begin(self, name: str, setpoints: int) -> None:
        """Say nothing."""

    def advance(self, setpoints: int) -> None:
        """Say nothing."""

    def end(self) -> None:
        """Say nothing."""
