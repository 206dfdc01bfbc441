"""The decorator that compiles a kernel, and the care its cache needs."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

Kernel = TypeVar("Kernel", bound=Callable[..., object])

njit: Any = None
try:
    from numba import njit
except ImportError:
    warnings.warn(
        "numba is not installed: gaik_core runs its kernels as plain Python, about a hundred times slower "
        "(pip install numba, or apt install python3-numba)",
        RuntimeWarning,
        stacklevel=2,
    )


def compiled(kernel: Kernel) -> Kernel:
    """Compile `kernel` on its first call and keep the machine code on disk; without numba, return it unchanged.

    Division by zero gives inf or nan as in numpy. No fast-math: compiled and plain runs give the same numbers.
    """
    return _njit(kernel)


def inlined(kernel: Kernel) -> Kernel:
    """`compiled`, for a formula that makes no array: part of each kernel that calls it, counting no references.

    A call between kernels, and counting who holds an array, cost 60 ns: more than a short formula itself.
    """
    return _njit(kernel, **_FORMULA)


def uncounted(kernel: Kernel) -> Kernel:
    """`inlined`, for what is too long to be part of its caller. It may cut views out of arrays, but make none.

    Nor may it return any, as `inlined` may not: a caller that counts references would give back what was not counted.
    """
    return _njit(kernel, **_LONG)


def _njit(kernel: Kernel, **options: bool) -> Kernel:
    if njit is None:
        return kernel
    result: Kernel = njit(cache=True, error_model="numpy", nogil=True, **options)(kernel)
    return result


def _known(**options: bool) -> dict[str, bool]:
    """Those of some options that this numba takes; they make code faster, never different."""
    known = {}
    for name, value in options.items():
        with suppress(Exception):  # what numba raises for an option it does not know differs by version
            njit(**{name: value})(lambda: 0)
            known[name] = value
    return known


_FORMULA = _known(forceinline=True, _nrt=False)
_LONG = _known(_nrt=False)


def drop_stale_caches() -> None:
    """Remove machine code older than any kernel source.

    numba looks only at the file of the function it loads; a kernel called from there may have changed since.
    """
    folder = Path(__file__).parent
    newest = max(source.stat().st_mtime for source in folder.glob("*.py"))
    for index in (folder / "__pycache__").glob("*.nbi"):
        with suppress(OSError):  # a read-only installation, or another process was quicker
            if index.stat().st_mtime < newest:
                index.unlink()
