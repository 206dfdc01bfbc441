"""Loops on absolute deadlines: a late tick does not move the ones after it.

A ROS timer skips the ticks it missed and so runs at 950 to 995 of 1000 Hz. Here a short lateness is caught up
tick by tick, and only a long stall is skipped, and counted.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

from gaik_ros.periods import PeriodWindow

CATCH_UP = 0.05  # s: a lateness up to this is caught up, a longer one skipped
LONGEST_SLEEP = 0.05  # s: how long a stop request may have to wait
BREATH = 5e-5  # s: pause between ticks that are caught up


class DeadlineSchedule:
    """The deadlines of one loop, at `start + n / rate`. Knows no clock: times in s are handed in."""

    def __init__(self, rate: float, catch_up: float = CATCH_UP) -> None:
        """`rate` in Hz. A lateness of more than `catch_up` s (and of two periods at least) is skipped."""
        if not rate > 0.0:
            raise ValueError(f"the rate of a loop is {rate} Hz: it must be above 0")
        self.period = 1.0 / rate
        self.catch_up = max(catch_up, 2.0 * self.period)
        self.skipped = 0
        self._start = 0.0
        self._next = 1  # number of the next deadline, counted from the start
        self._last = 0  # number of the deadline of the last tick

    def start(self, now: float) -> None:
        """Count the deadlines from `now`; the first is one period later."""
        self._start, self._next, self._last = now, 1, 0

    @property
    def deadline(self) -> float:
        """When the next tick is due, in s."""
        return self._start + self._next * self.period

    def due(self, now: float) -> float | None:
        """The `dt` in s of the tick that is due at `now`, or None before the deadline.

        `dt` is the distance between this tick's deadline and the last one's: a whole number of periods, more
        than one after a skip only, so that the sum of all `dt` keeps up with the clock.
        """
        if now < self.deadline:
            return None
        if now - self.deadline > self.catch_up:
            newest = int((now - self._start) / self.period)
            self.skipped += max(0, newest - self._next)
            self._next = max(self._next, newest)
        dt = (self._next - self._last) * self.period
        self._last = self._next
        self._next += 1
        return dt


class DeadlineLoop:
    """Calls `tick(dt)` at `rate` Hz once a LoopThread runs it, and keeps statistics of the periods."""

    def __init__(self, rate: float, tick: Callable[[float], None]) -> None:
        self.rate = rate
        self.tick = tick
        self.schedule = DeadlineSchedule(rate)
        self.periods = PeriodWindow(1.0 / rate)

    def start(self, now: float) -> None:
        """Begin counting deadlines."""
        self.schedule.start(now)

    def run_due(self, now: float) -> bool:
        """Make the tick that is due at `now`, if one is; True if one was."""
        skipped_before = self.schedule.skipped
        dt = self.schedule.due(now)
        if dt is None:
            return False
        self.periods.add(now, self.schedule.skipped - skipped_before)
        self.tick(dt)
        return True


class LoopThread:
    """One thread that runs all loops of a process, the one with the earliest deadline first.

    One thread, because threads that wake each other a thousand times a second spend it waiting for the
    interpreter's lock.
    """

    def __init__(
        self, loops: Sequence[DeadlineLoop], on_error: Callable[[BaseException], None] | None = None
    ) -> None:
        """`on_error` is called from the thread with what a tick raised; the thread ends after it."""
        self._loops = list(loops)
        self._on_error = on_error
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="deadline loops", daemon=True)
        self.error: BaseException | None = None

    def start(self) -> None:
        """Start ticking."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread after the tick it is in, and wait for that."""
        self._stopping = True
        if self._thread.is_alive():
            self._thread.join()

    def _run(self) -> None:
        try:
            now = time.monotonic()
            for loop in self._loops:
                loop.start(now)
            while self._loops and not self._stopping:
                self._round()
        except BaseException as error:
            self.error = error
            if self._on_error is not None:
                self._on_error(error)

    def _round(self) -> None:
        """Sleep until the earliest deadline, then make one tick of each loop that is due."""
        earliest = min(self._loops, key=lambda loop: loop.schedule.deadline).schedule
        wait = earliest.deadline - time.monotonic()
        if wait > 0.0:
            time.sleep(min(wait, LONGEST_SLEEP))
        elif wait < -earliest.period:
            # Ticks that are caught up shall act on what has arrived meanwhile: let the executor have its turn.
            time.sleep(BREATH)
        for loop in self._loops:
            loop.run_due(time.monotonic())
