"""What every law of wear by pressure offers."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Any

import numpy as np

Choice = Callable[[Any, Any, Any], Any]
NO_FRICTION = (0.0, 0.0)


def if_positive(test: Any, then: Any, otherwise: Any) -> Any:
    """``then`` where ``test`` > 0, else ``otherwise``; of numbers and arrays."""
    return np.where(np.asarray(test) > 0, then, otherwise)


class WearLaw(abc.ABC):
    """Depth over sliding distance ``k p phi(p)``: k of a contact's specific wear rate, p the Cauchy pressure.

    Per reference area the depth is ``W = k ds P phi(p) / J`` with the nominal pressure P. Archard's law is phi = 1, a
    contact without any of these. The formulas are plain arithmetic but for a choice, which is handed in: numbers,
    arrays and NGSolve's coefficient functions may come in.

    Attributes
    ----------
    needs_friction : bool
        Whether phi takes the coefficient of friction.
    """

    needs_friction: bool = False

    @abc.abstractmethod
    def factor(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        """The factor phi [-] at a Cauchy pressure > 0 [MPa].

        ``friction`` is mu [-] and its slope dmu/dp [1/MPa] there, ``choose(test, then, otherwise)`` as ``if_positive``.
        """

    @abc.abstractmethod
    def slope(self, pressure: Any, friction: tuple[Any, Any] = NO_FRICTION, choose: Choice = if_positive) -> Any:
        """``d(p phi) / dp`` [-] there."""

    @property
    @abc.abstractmethod
    def words(self) -> str:
        """The law in a line."""
