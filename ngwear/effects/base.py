"""What every term of the equilibrium offers."""

from __future__ import annotations

import abc
from dataclasses import dataclass, field
from typing import Any

import ngsolve as ng

from ngwear.fields.kinematics import Kinematics
from ngwear.geometry.body import Body

DISPLACEMENT = "displacement"


@dataclass(frozen=True)
class Unknowns:
    """Trial and test functions by name, and the body and kinematics they live on."""

    body: Body
    kinematics: Kinematics
    trial: dict[str, Any]
    test: dict[str, Any]
    state: dict[str, ng.GridFunction] = field(default_factory=dict)

    @property
    def u(self) -> Any:
        """Trial displacement."""
        return self.trial[DISPLACEMENT]

    @property
    def v(self) -> Any:
        """Test displacement."""
        return self.test[DISPLACEMENT]


class Term(abc.ABC):
    """One effect's share of the equilibrium.

    Residuals and tangents are pure functions of the unknowns and of parameters that change between
    solves only. ``loads`` maps names such as ``"rod approach [mm]"`` to those parameters that a program
    of loads may set.
    """

    symmetric: bool = True

    def __init__(self) -> None:
        self.loads: dict[str, ng.Parameter] = {}

    def spaces(self, body: Body) -> dict[str, ng.FESpace]:
        """Unknowns that the term adds, by name."""
        return {}

    @abc.abstractmethod
    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        """Add energies (``Variation``) or forms to the equilibrium."""

    def prepare(self) -> None:  # noqa: B027 - most terms have nothing to freeze
        """Freeze, from the state that a solve starts from, what stays fixed in that solve."""

    def refresh(self) -> bool:
        """After a solve, update what was fixed in it; True asks for another solve."""
        return False
