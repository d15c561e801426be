"""Unilateral contact with a rigid surface; wear enters as a compliance."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT, Term, Unknowns
from ngwear.effects.rounding import Rounding
from ngwear.geometry.meshed import Meshed
from ngwear.surfaces import RigidSurface

if TYPE_CHECKING:  # brings friction along
    from ngwear.effects.pressure_wear import PressureWear

Array = NDArray[np.float64]
SOFTNESS = (1.0, 10.0)  # in the first attempt, and the second, which gets large steps onto curved contacts through
COORDINATES = (ng.x, ng.y, ng.z)


class UnilateralContact(Term):
    """Contact pressure as an unknown on named edges: ``0 <= P  _|_  g(X + u) + kappa P / (da/dA) >= 0``.

    P is the nominal (first Piola) pressure; g the signed distance from the surface. ``kappa = k ds`` is the
    implicit Archard step of a specific wear rate k [mm²/N] over a sliding distance ds [mm]: the depth kappa P is
    worn per reference area while the gap closes by kappa p with the Cauchy pressure p = P / (da/dA). The stretch
    da/dA in the gap is that of the state from which the solve starts; the depth itself is exact.

    The energy is the augmented Lagrangian ``1/(2c) [ max(0, P - c g)^2 / (1 + c kappa) - P^2 ]`` (Alart &
    Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353, with the compliance added): symmetric, exact
    for every c > 0, and semismooth under Newton.

    A surface may move along its ``approach`` by the load ``"NAME approach [mm]"``; under force control
    (``force_controlled=True``) that displacement is an unknown and the load is ``"NAME force [N]"`` (N per
    mm of thickness in plane strain).

    Parameters
    ----------
    name : str
    edges : sequence of str
        Names of the edges (faces of a solid) that may touch.
    surface : RigidSurface
    force_controlled : bool
    modulus : float
        Shear modulus G of the body [MPa]. With the length h of a mesh edge it sets the scales of the method,
        not of the solution: ``1/c = softness h / (2 G) + kappa``, and a compliance of 1e-6 h / G (a closure of
        1e-6 h at P = G) that keeps the pivots of the factorisation away from zero.

    Attributes
    ----------
    compliance : ng.Parameter
        kappa [mm/MPa].
    slips_in_part : bool
        Set by friction with stick: kappa is then multiplied by ``share``, the slip over the sliding distance, linear
        between mesh nodes and 1 at first.
    worn : ng.GridFunction or None
        Depth worn in the same step independent of P [mm per reference area], if the contact has one.
    pressure_wear : PressureWear or None
        To be set before the contact is added to a form: a law of wear other than Archard's, by which kappa p becomes
        ``kappa p phi(p)``.
    rounding : Rounding or None
        To be set before the contact is added to a form, if ``round_off`` is to work.
    near : BitArray or None
        Surface elements that may touch in the present solve; None: all.
    finest : float
        Shortest of ``lengths`` [mm], once it has been added to a form.
    softness : ng.Parameter
        Divides c, 1 at first. With a large c the gaps decide where there is contact, which converges fast on flat
        faces; with a small c the pressures decide, and large steps into a strongly curved contact converge.
    """

    _points: Any  # of the mesh, mapped

    def __init__(
        self,
        name: str,
        edges: Sequence[str],
        surface: RigidSurface,
        *,
        force_controlled: bool = False,
        modulus: float,
    ) -> None:
        super().__init__()
        self.name, self.edges, self.surface = name, tuple(edges), surface
        self.force_controlled = force_controlled
        self.modulus = modulus
        self.softness = ng.Parameter(1.0)
        self.new_points_slip = ng.Parameter(0.0)
        self.rounding: Rounding | None = None
        self.near: ng.BitArray | None = None
        self.compliance = ng.Parameter(0.0)
        self.slips_in_part = False
        self.share: ng.GridFunction | None = None
        self.worn: ng.GridFunction | None = None
        self.pressure_wear: PressureWear | None = None
        self.load = ng.Parameter(0.0)
        self._extent = ng.Parameter(1.0)  # of the whole surface as it is meshed and worn [mm, or mm²]
        kind = "force [N]" if force_controlled else "approach [mm]"
        self.loads = {f"{name} {kind}": self.load}
        self.tractions = (self.pressure_name,)

    @property
    def pressure_name(self) -> str:
        """Name of the nominal pressure among the unknowns."""
        return f"{self.name} pressure"

    @property
    def travel_name(self) -> str:
        """Name of the surface's displacement among the unknowns, under force control."""
        return f"{self.name} approach"

    @abc.abstractmethod
    def pressure_space(self, body: Meshed) -> ng.FESpace:
        """Space of the nominal pressure on the named edges."""

    def measure(self, **where: Any) -> Any:
        """Integration measure of the contact law on the edges."""
        return ng.ds(definedon=self._region, bonus_intorder=2, **where)

    @property
    def where_near(self) -> dict[str, ng.BitArray]:
        """Keyword of an integration measure for forms (not for energies) that are zero without pressure."""
        return {} if self.near is None else {"definedonelements": self.near}

    @abc.abstractmethod
    def lengths(self, unknowns: Unknowns) -> ng.GridFunction:
        """Undeformed length of each surface element [mm]; constant on it."""

    @abc.abstractmethod
    def sample_middles(self, field: ng.CoefficientFunction) -> Array:
        """Values of a field in the middle of each surface element."""

    @abc.abstractmethod
    def peak(self) -> float:
        """Highest Cauchy pressure of the present state [MPa]."""

    def spaces(self, body: Meshed) -> dict[str, ng.FESpace]:
        spaces = {self.pressure_name: self.pressure_space(body)}
        if self.force_controlled:
            spaces[self.travel_name] = ng.NumberSpace(body.mesh)
        return spaces

    def motion(self, fields: dict[str, Any]) -> tuple[Any, ...]:
        """Displacement of the rigid surface [mm], for trial functions or a state."""
        travel = fields[self.travel_name] if self.force_controlled else self.load
        return tuple(travel * a for a in self.surface.approach)

    def stands(self) -> tuple[float, ...]:
        """Displacement of the surface in the present state [mm]."""
        somewhere = self._points[:1]
        return tuple(np.asarray(ng.CF(m)(somewhere)).item() for m in self.motion(self._state))

    def place(self, fields: dict[str, Any]) -> tuple[Any, ...]:
        """Coordinates of X + u in the frame of the moving surface, for trial functions or a state."""
        u, motion = fields[DISPLACEMENT], self.motion(fields)
        return tuple(COORDINATES[i] + u[i] - m for i, m in enumerate(motion))

    def virtual(self, unknowns: Unknowns) -> tuple[Any, ...]:
        """Virtual displacement of the part past the surface: a surface under force moves too and transmits friction."""
        if not self.force_controlled:
            return tuple(unknowns.v[i] for i in range(len(self.surface.approach)))
        travel = unknowns.test[self.travel_name]
        return tuple(unknowns.v[i] - travel * a for i, a in enumerate(self.surface.approach))

    def gap(self, fields: dict[str, Any]) -> Any:
        """Signed distance of the deformed surface from the surface [mm]."""
        return self.surface.gap(*self.place(fields))

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        body, kinematics = unknowns.body, unknowns.kinematics
        self._body, self._region = body, body.boundary(self.edges)
        self._state, self._kinematics = unknowns.state, kinematics
        self._start = ng.GridFunction(unknowns.state[DISPLACEMENT].space)
        stretch = kinematics.area_stretch(self._start, ng.Grad(self._start))
        lengths = self.lengths(unknowns)
        edges = lengths.vec.FV().NumPy()
        self.finest = float(edges[edges > 0].min())
        give = lengths / self.modulus
        kappa = self.compliance
        if self.slips_in_part:
            self.share = ng.GridFunction(ng.H1(body.mesh, order=1))
            self.share.vec[:] = 1.0
            kappa = kappa * self.share
        rest, steepest = None, kappa
        if self.pressure_wear is not None:
            slope, rest, steepest = self.pressure_wear.tangent(unknowns.state[self.pressure_name], stretch)
            kappa, rest, steepest = kappa * slope, kappa * rest, kappa * steepest
        self._augmentation = c = 1 / (0.5 * self.softness * give + steepest)
        worn = None if self.worn is None else self.worn / stretch
        if rest is not None:
            worn = rest if worn is None else worn + rest
        p = unknowns.trial[self.pressure_name]
        pushed, now = (
            fields[self.pressure_name] - c * (self.gap(fields) if worn is None else self.gap(fields) + worn)
            for fields in (unknowns.trial, unknowns.state)
        )
        closure = 1 + c * (1e-6 * give + kappa / stretch)
        self._acts = ng.IfPos(now, now / closure, 0.0)
        active = ng.IfPos(pushed, pushed * pushed / closure, 0.0)
        if self.rounding is not None:
            active = self.rounding.choose(self.rounding.square(pushed) / closure, active)
        if self.near is None:
            energy = (active - p * p) / (2 * c) * kinematics.weight
            form += ng.Variation(energy.Compile() * self.measure())
        else:
            form += ng.Variation((-p * p / (2 * c) * kinematics.weight).Compile() * self.measure())
            self._add_near(form, active / (2 * c) * kinematics.weight, unknowns)
        if self.force_controlled:
            # A constant energy density over the whole surface adds up to - force * travel.
            everywhere = body.mesh.Boundaries(".*")
            travel = unknowns.trial[self.travel_name]
            form += ng.Variation(-self.load * travel / self._extent * ng.ds(definedon=everywhere))
        self._measure()

    def _add_near(self, form: ng.BilinearForm, energy: ng.CoefficientFunction, unknowns: Unknowns) -> None:
        """Add the variation of an energy on the edges that are near: NGSolve's ``Variation`` takes all of a region."""
        work = sum(
            energy.Diff(unknowns.trial[name], unknowns.test[name])
            for name in (DISPLACEMENT, self.pressure_name, self.travel_name)
            if name in unknowns.trial
        )
        form += work.Compile() * self.measure(**self.where_near)

    def gather(self) -> None:
        if self.pressure_wear is not None:
            self.pressure_wear.gather()

    def wear_factor(self, pressure: Array) -> Array | float:
        """Factor phi on k p of a law of wear other than Archard's, at Cauchy pressures [MPa]."""
        return 1.0 if self.pressure_wear is None else self.pressure_wear.factor(pressure)

    def force(self) -> Array:
        """Resultant of the contact pressure on the rubber; [N], or N/mm in plane strain.

        It is that of the equilibrium, ``int max(0, P - c g) n dA``. The pressure P is equal to it on each element in
        the mean only, which is not enough where the normal n turns within an element.
        """
        acts = self._acts * self._kinematics.weight
        normal = self.surface.normal(*self.place(self._state))
        return np.array([ng.Integrate(acts * n * self.measure(), self._body.mesh) for n in normal])

    def attempt(self, number: int) -> bool:
        self.softness.Set(SOFTNESS[number])
        return True

    def round_off(self, relative: float) -> bool:
        if self.rounding is None:
            return False
        self.rounding.set(relative)
        return True

    def prepare(self) -> None:
        self._start.vec.data = self._state[DISPLACEMENT].vec
        self._measure()
        if self.pressure_wear is not None:
            self.pressure_wear.prepare(self.peak())

    def _measure(self) -> None:
        """Extent of the whole surface as the mesh has it now, curved and worn."""
        if self.force_controlled:
            everywhere = self._body.mesh.Boundaries(".*")
            self._extent.Set(ng.Integrate(ng.CF(1.0) * ng.ds(definedon=everywhere), self._body.mesh))
