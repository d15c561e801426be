"""What every term of the equilibrium offers."""

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
    """Trial and test functions and state by name, and the body, kinematics and material points they live on."""

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
        """The material points; SceneError where no term has any."""
        if self.inside is None:
            raise SceneError("terms", list(self.trial), "none is of the part's inside: there are no material points")
        return self.inside

    @property
    def section(self) -> MeshedSection:
        """The body of a term along an outline; SceneError where it has none."""
        if not isinstance(self.body, MeshedSection):
            raise SceneError("part", type(self.body).__name__, "is no section, and has no outline")
        return self.body

    def seat(self, background: Background) -> Seat:
        """The body on a background that keeps its memory."""
        from ngwear.fields.background_mesh import Seat

        displacement = self.state[DISPLACEMENT]
        return Seat(
            background, body=self.body, kinematics=self.kinematics, points=self.points, displacement=displacement
        )


class Term(abc.ABC):
    """One effect's share of the equilibrium.

    Residuals and tangents are pure functions of the unknowns and of parameters that change between
    solves only. ``loads`` maps names such as ``"rod approach [mm]"`` to those parameters that a program
    of loads may set, ``tractions`` names the unknowns that a solve must have settled.
    """

    symmetric: bool = True
    remembers: bool = False  # whether every step of a walk must be as exact as its last
    tractions: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.loads: dict[str, ng.Parameter] = {}

    def spaces(self, body: Meshed) -> dict[str, ng.FESpace]:
        """Unknowns that the term adds, by name."""
        return {}

    @abc.abstractmethod
    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        """Add energies (``Variation``) or forms on the outline to the equilibrium."""

    def gather(self) -> None:  # noqa: B027 - most terms need but what is near
        """Before each residual, take from the present state what the form, which sees one element, cannot."""

    def prepare(self) -> None:  # noqa: B027 - most terms have nothing to freeze
        """Freeze, from the state that a solve starts from, what stays fixed in that solve."""

    def refresh(self) -> bool:
        """After a solve, update what was fixed in it; True asks for another solve."""
        return False

    def commit(self, strain: Array) -> None:  # noqa: B027 - most terms have no memory
        """Move the memory to the end of a step that is accepted; ``strain`` is that of the material points, if any."""

    def set_time_step(self, step: float) -> None:  # noqa: B027 - most terms know no time
        """Length of the step that is solved next [s]; infinity for an equilibrium that is left for ever."""


class VolumeTerm(Term):
    """A term of the section's inside: a stress at each material point."""

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        """Nothing on the outline."""

    @abc.abstractmethod
    def response(self, strain: Array, *, tangent: bool) -> tuple[Array, Array | None]:
        """Stress conjugate to the strain of ``fields.material_points`` and, if asked for, its derivative.

        Shapes (..., n) and (..., n, n), symmetric, per reference volume; not a number where the strain is not
        admissible (J <= 0).
        """
