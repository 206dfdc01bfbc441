"""The update rules: each class holds the settings of one kernel in `gaik_core.kernels.rules`, and nothing that changes.

A new rule is one such class, and one kernel added to `step` there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import astuple, dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from gaik_core.checks import is_number
from gaik_core.errors import GaikError, UnknownNameError
from gaik_core.kernels import rules as kernels

Array = NDArray[np.float64]


class UpdateRule:
    """How one update follows from the error and the Jacobian.

    Attributes:
        kernel: number of the compiled step.
        settings: the numbers it takes.
        window: a solve has stagnated after this many updates without progress.
    """

    kernel: ClassVar[int]
    window: ClassVar[int] = 50

    @cached_property
    def settings(self) -> Array:
        """The rule's numbers in the order of its fields."""
        return np.array(astuple(self), dtype=np.float64)  # type: ignore[call-overload]

    def _positive(self, *names: str) -> None:
        self._check(names, lambda value: 0.0 < value < math.inf, "above 0 and finite")

    def _share(self, *names: str) -> None:
        self._check(names, lambda value: 0.0 <= value < 1.0, "at least 0 and below 1")

    def _check(self, names: tuple[str, ...], holds: Callable[[Any], bool], expected: str) -> None:
        for name in names:
            value = getattr(self, name)
            if not (is_number(value) and holds(value)):
                raise GaikError(f"{type(self).__name__}: {name} is {value!r}; expected a number {expected}")


@dataclass(frozen=True)
class GradientDescent(UpdateRule):
    """θ ← θ + α Jᵀ e (eqs. 34 and 53).

    `learning_rate` is α in rad²/m² for the loss ½ |e|²; with "auto" each step is the best one of the linearised arm, so
    that no α need be found per robot (Buss 2004); no joint moves further than π/4 in one.
    """

    learning_rate: float | Literal["auto"] = "auto"

    def __post_init__(self) -> None:
        if self.learning_rate != "auto":
            self._positive("learning_rate")

    @property
    def kernel(self) -> int:  # type: ignore[override]
        """Fixed or chosen step."""
        return kernels.STEEPEST_DESCENT if self.learning_rate == "auto" else kernels.GRADIENT_DESCENT

    @cached_property
    def settings(self) -> Array:
        """(α,); unused where the step is chosen."""
        return np.array([0.0 if self.learning_rate == "auto" else self.learning_rate])


@dataclass(frozen=True)
class Momentum(UpdateRule):
    """Gradient descent that keeps a share `momentum` of its last step (Polyak 1964)."""

    kernel: ClassVar[int] = kernels.MOMENTUM
    learning_rate: float = 0.5
    momentum: float = 0.8
    window: ClassVar[int] = 100

    def __post_init__(self) -> None:
        self._positive("learning_rate")
        self._share("momentum")


@dataclass(frozen=True)
class Nesterov(Momentum):
    """Momentum whose gradient is taken where the momentum leads (Nesterov 1983, as in Sutskever et al. 2013)."""

    kernel: ClassVar[int] = kernels.NESTEROV


@dataclass(frozen=True)
class RMSProp(UpdateRule):
    """Each joint's step divided by the running size of its gradient (Hinton 2012)."""

    kernel: ClassVar[int] = kernels.RMSPROP
    learning_rate: float = 0.01
    decay: float = 0.9
    epsilon: float = 1e-8
    window: ClassVar[int] = 100

    def __post_init__(self) -> None:
        self._positive("learning_rate", "epsilon")
        self._share("decay")


@dataclass(frozen=True)
class Adam(UpdateRule):
    """Adaptive moments (Kingma and Ba 2015): the rule of the paper's Table 1, with its settings there as defaults."""

    kernel: ClassVar[int] = kernels.ADAM
    learning_rate: float = 0.05
    beta1: float = 0.9
    beta2: float = 0.999
    epsilon: float = 1e-8
    window: ClassVar[int] = 100

    def __post_init__(self) -> None:
        self._positive("learning_rate", "epsilon")
        self._share("beta1", "beta2")


@dataclass(frozen=True)
class AMSGrad(Adam):
    """Adam whose second moment never shrinks (Reddi, Kale and Kumar 2018)."""

    kernel: ClassVar[int] = kernels.AMSGRAD


@dataclass(frozen=True)
class DampedLeastSquares(UpdateRule):
    """θ ← θ + Jᵀ (J Jᵀ + λ² I)⁻¹ e with a constant `damping` λ in m (Wampler 1986)."""

    kernel: ClassVar[int] = kernels.DAMPED
    damping: float = 0.05
    window: ClassVar[int] = 30

    def __post_init__(self) -> None:
        self._positive("damping")


@dataclass(frozen=True)
class LevenbergMarquardt(UpdateRule):
    """Damped least squares whose damping fades with the loss: λ² = c ½ |e|² + b tr(J Jᵀ)/r (Sugihara 2011).

    Far from the target it steps like gradient descent, by 1/√(2c) rad at most; near it, like Newton's method. Where the
    loss grew the damping is raised, so that under a target out of reach the arm settles.
    `damping` is c: Sugihara's 1, or less; at 1/4 a Panda takes the fewest updates.
    """

    kernel: ClassVar[int] = kernels.LEVENBERG_MARQUARDT
    damping: float = 0.25
    bias: float = 1e-6
    window: ClassVar[int] = 10

    def __post_init__(self) -> None:
        self._positive("damping", "bias")


RULES: dict[str, type[UpdateRule]] = {
    "gradient_descent": GradientDescent,
    "momentum": Momentum,
    "nesterov": Nesterov,
    "rmsprop": RMSProp,
    "adam": Adam,
    "amsgrad": AMSGrad,
    "damped_least_squares": DampedLeastSquares,
    "levenberg_marquardt": LevenbergMarquardt,
}


def rule_by_name(name: str, learning_rate: float | Literal["auto"] | None = None) -> UpdateRule:
    """The rule of a name with its default settings, and this learning rate where one is given and the rule has one.

    Raises:
        UnknownNameError: no such rule; the message lists those there are.
        GaikError: a learning rate the rule cannot take.
    """
    if not isinstance(name, str) or name not in RULES:
        raise UnknownNameError("update rule", name, RULES)
    rule = RULES[name]
    if learning_rate is None or "learning_rate" not in rule.__dataclass_fields__:  # type: ignore[attr-defined]
        return rule()
    return rule(learning_rate=learning_rate)  # type: ignore[call-arg]
