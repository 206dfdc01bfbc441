"""Conformal geometric algebra G(4,1) (paper, section 2.3): multivectors, their products, and their geometry."""

from gaik_core.cga import blades
from gaik_core.cga.multivector import Multivector

__all__ = ["Multivector", "blades"]
