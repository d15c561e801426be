"""Base class of all laws of wear by pressure."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Any

import numpy as np

Choice = Callable[[Any, Any, Any], Any]
NO_FRICTION = (0.0, 0.0)


def if_positive(test: Any, then: Any, otherwise: Any) -> Any:
    """``then`` where ``test`` > 0, else ``otherwise``; for numbers and arrays."""
    return np.where(np.asarray(test) > 0, then, otherwise)


class WearLaw(abc.ABC):
    """Depth over sliding distance ``k p phi(p)``, with the contact's specific wear rate k and the Cauchy pressure p.

    Per reference area the depth is ``W = k ds P phi(p) / J`` with the nominal pressure P. phi = 1 is Archard's law, the
    default of a contact. The formulas use plain arithmetic and ``choose`` for case distinctions, so that numbers,
    arrays and NGSolve's coefficient functions are allowed.

    Attributes
    ----------
    needs_friction : bool
        Whether phi depends on the coefficient of friction.
    """

    needs_friction: bool = False

    @abc.abstractmethod
    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        """Factor phi [-] at a Cauchy pressure > 0 [MPa].

        ``friction`` is mu [-] and its slope dmu/dp [1/MPa] there, ``choose(test, then, otherwise)`` as ``if_positive``.
        """

    @abc.abstractmethod
    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        """Slope ``d(p phi) / dp`` [-]; arguments as of ``factor``."""

    @property
    @abc.abstractmethod
    def words(self) -> str:
        """The law in one line of text."""
