"""Base classes of the terms of the equilibrium, one for each physical effect."""

from __future__ import annotations

import abc
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import SceneError
from ngwear.fields.kinematics import Kinematics
from ngwear.fields.material_points import MaterialPoints
from ngwear.geometry.meshed import Meshed
from ngwear.geometry.meshed_section import MeshedSection

if TYPE_CHECKING:  # no memory, no import of it
    from ngwear.fields.background_mesh import Background, Seat

Array = NDArray[np.float64]

DISPLACEMENT = "displacement"
VOLUMETRIC_STRESS = "volumetric stress"


@dataclass(frozen=True)
class Unknowns:
    """Trial functions, test functions and state by name, with the body, kinematics and material points."""

    body: Meshed
    kinematics: Kinematics
    trial: dict[str, Any]
    test: dict[str, Any]
    state: dict[str, ng.GridFunction] = field(default_factory=dict)
    inside: MaterialPoints | None = None

    @property
    def u(self) -> Any:
        """Trial displacement."""
        return self.trial[DISPLACEMENT]

    @property
    def v(self) -> Any:
        """Test displacement."""
        return self.test[DISPLACEMENT]

    @property
    def points(self) -> MaterialPoints:
        """The material points; SceneError if no term has any."""
        if self.inside is None:
            raise SceneError("terms", list(self.trial), "no term acts inside the part: there are no material points")
        return self.inside

    @property
    def section(self) -> MeshedSection:
        """The body as a section with an outline; SceneError if it is a solid."""
        if not isinstance(self.body, MeshedSection):
            raise SceneError("part", type(self.body).__name__, "is not a section and has no outline")
        return self.body

    def seat(self, background: Background) -> Seat:
        """The body on a background that stores the viscoelastic history."""
        from ngwear.fields.background_mesh import Seat

        displacement = self.state[DISPLACEMENT]
        return Seat(
            background, body=self.body, kinematics=self.kinematics, points=self.points, displacement=displacement
        )


class Term(abc.ABC):
    """One effect's share of the equilibrium.

    Residuals and tangents are functions of the unknowns and of parameters that change between solves only. ``loads``
    maps names such as ``"rod approach [mm]"`` to those parameters that a program of loads may set, ``tractions`` names
    the unknowns that must have converged at the end of a solve.
    """

    symmetric: bool = True
    remembers: bool = False  # whether every load step must be as exact as the last one
    tractions: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.loads: dict[str, ng.Parameter] = {}

    def spaces(self, body: Meshed) -> dict[str, ng.FESpace]:
        """Unknowns that the term adds, by name."""
        return {}

    @abc.abstractmethod
    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        """Add energies (``Variation``) or forms on the outline to the equilibrium."""

    def gather(self) -> None:  # noqa: B027 - most terms need only local values
        """Before each residual, compute from the present state what is not local to one element."""

    def limit(self, correction: Array) -> None:  # noqa: B027 - most terms bear any displacement
        """Shorten a correction of the displacement, to be subtracted from the state, in place."""

    def prepare(self) -> None:  # noqa: B027 - most terms fix nothing
        """Before a solve, compute from its start state the quantities that stay fixed in it."""

    def attempt(self, number: int) -> bool:
        """Before attempt 0 of a solve, and before attempt 1 if that has failed; True if the term changes its way.

        It may change the way to the solution, not the solution.
        """
        return False

    def round_off(self, relative: float) -> bool:
        """Round off the corners of the law over ``relative`` times the shear modulus; 0: not. True if the term can."""
        return False

    def hold_back(self, strength: float) -> bool:
        """Hold the part at its present state with springs of this strength [-]; 0: none. True if the term can."""
        return False

    def refresh(self, *, solved: bool = False) -> bool:
        """Update the quantities that are fixed in a solve; True if another solve is necessary.

        ``solved``: whether the state is an equilibrium that a solve with them has found, and not a guess of one.
        """
        return False

    def commit(self, strain: Array) -> None:  # noqa: B027 - most terms have no memory
        """Update the history at the end of an accepted step; ``strain`` is that of the material points, if any."""

    def set_time_step(self, step: float) -> None:  # noqa: B027 - most terms do not depend on time
        """Length of the next time step [s]; infinity for the long-term equilibrium."""


class VolumeTerm(Term):
    """A term inside the part: a stress at each material point."""

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        """Nothing on the outline."""

    @abc.abstractmethod
    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        """Stress conjugate to the strain of ``fields.material_points`` and, if asked for, its derivative.

        Shapes (..., n) and (..., n, n), symmetric, per reference volume; not a number where the strain is not
        admissible (J <= 0).
        """
