"""The blades of G(4,1) as names: `from gaik_core.cga.blades import e1, e23, e0, einf`, or `blades.e12`.

Any order of digits is a name, and gives its sign: `blades.e31 == -blades.e13`. I = e12345 is the pseudoscalar and
Ie = e123 the Euclidean one (eq. 13). `from … import *` gives nothing: names like e1 belong in no one's globals unasked.
"""

from __future__ import annotations

from gaik_core.cga.basis import NAMES, BladeNameError
from gaik_core.cga.multivector import Multivector, wrap
from gaik_core.cga.printing import named_blade

__all__: list[str] = []

# by name, not by products, which would load the compiled kernels at import
e1, e2, e3, e4, e5, Ie, I = (  # noqa: E741 - what the field calls the pseudoscalar
    wrap(named_blade(name)) for name in ("e1", "e2", "e3", "e4", "e5", "e123", "e12345")
)
e0: Multivector = 0.5 * (e5 - e4)
einf: Multivector = e4 + e5


def __getattr__(name: str) -> Multivector:
    try:
        return wrap(named_blade(name))
    except BladeNameError as error:
        raise AttributeError(f"{error}; or one of e0, einf, I, Ie") from None


def __dir__() -> list[str]:
    return [*NAMES[1:], "e0", "einf", "I", "Ie"]
