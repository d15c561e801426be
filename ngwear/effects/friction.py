"""Friction along a contact, and its simple form for strokes much longer than the elastic slip: full sliding."""

from __future__ import annotations

import abc
import math
from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Term, Unknowns
from ngwear.effects.coefficient import Coefficient
from ngwear.effects.contact import OutlineContact
from ngwear.effects.ripples import Ripples
from ngwear.effects.unilateral import UnilateralContact
from ngwear.laws import Constant, FrictionLaw


class Friction(Term):
    """Coulomb friction of a contact under a law.

    For a surface under force, the force is in equilibrium with pressure and friction together.

    Parameters
    ----------
    contact : UnilateralContact
    law : FrictionLaw or float
        mu [-], >= 0. A law by pressure uses the Cauchy pressure P / (da/dA) of the unknown state.
    speed : float or None
        First sliding speed [mm/s].

    Attributes
    ----------
    coefficient : Coefficient
        Its ``set_state`` sets the distance and the speed of the next solve.

    Raises
    ------
    SceneError
        For a negative coefficient.
    """

    symmetric = False
    _unknowns: Unknowns

    def __init__(self, contact: UnilateralContact, law: FrictionLaw | float, *, speed: float | None = None) -> None:
        super().__init__()
        self.contact, self.coefficient = contact, Coefficient(contact.name, law, speed=speed)

    @abc.abstractmethod
    def force(self) -> Array:
        """Resultant of the friction on the part; [N], or N/mm in plane strain."""

    @abc.abstractmethod
    def heat(self, way: float) -> float:
        """Heat of a stroke in which the surface slides a way [mm]; [mJ], or mJ/mm in plane strain."""

    @property
    def varies(self) -> bool:
        """Whether the law is not a constant."""
        return not isinstance(self.coefficient.law, Constant)

    def mu(self) -> Any:
        """Coefficient of friction at the present state [-], a field for a law by pressure."""
        state, kinematics = self._unknowns.state, self._unknowns.kinematics
        u = state[DISPLACEMENT]
        return self.coefficient(state[self.contact.pressure_name] / kinematics.area_stretch(u, ng.Grad(u)))

    def mean(self) -> float:
        """Friction limit over load, ``int mu P dA / int P dA`` [-]; 0 without contact."""
        pressure = self._unknowns.state[self.contact.pressure_name]
        load = self._integral(pressure)
        return self._integral(self.mu() * pressure) / load if load > 0 else 0.0

    def _integral(self, traction: Any) -> float:
        """Of a nominal traction over the contact's edges, at the present state."""
        known = self._unknowns
        measure = ng.ds(definedon=known.body.boundary(self.contact.edges), bonus_intorder=2)
        return float(ng.Integrate(traction * known.kinematics.weight * measure, known.body.mesh))


class FullSliding(Friction):
    """Traction ``mu P`` along the surface's motion everywhere in contact (Coulomb, no stick zone).

    The load ``"NAME slip"`` in [-1, 1] is the direction in which the surface moves along its tangent (the
    surface's normal turned clockwise); values between ramp a reversal. Neglects the stick phase after a
    reversal, whose length is the rubber's tangential deflection. The tangent matrix is unsymmetric. On an outline, the
    friction of pressure ripples is shifted a little downstream (see ``Ripples``), but not on an outline with steps
    (``stepped``), where the pressure has no smooth part. Other parameters and errors as of ``Friction``.
    """

    def __init__(
        self, contact: UnilateralContact, law: FrictionLaw | float, *, speed: float | None = None, stepped: bool = False
    ) -> None:
        super().__init__(contact, law, speed=speed)
        self.stepped = stepped
        self.slip = ng.Parameter(1.0)
        self.loads = {f"{contact.name} slip": self.slip}
        self._ripples: Ripples | None = None

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        contact = self.contact
        p = unknowns.trial[contact.pressure_name]
        u = unknowns.u
        tangent = contact.surface.tangent(*contact.place(unknowns.trial))
        stretch = unknowns.kinematics.area_stretch(u, ng.Grad(u).Trace())
        mu = self.coefficient(p / stretch) * unknowns.kinematics.weight
        work = -mu * self.slip * p * sum(t * v for t, v in zip(tangent, contact.virtual(unknowns), strict=True))
        if isinstance(contact, OutlineContact):
            self._ripples = Ripples(contact, unknowns)
        if self._ripples is not None and not self.stepped:
            work += mu * ng.IfPos(self.slip, self.slip, -self.slip) * self._ripples.moved
        self._unknowns = unknowns
        region = unknowns.body.boundary(contact.edges)
        form += work.Compile() * ng.ds(definedon=region, bonus_intorder=2, **contact.where_near)

    def gather(self) -> None:
        if self._ripples is not None and not self.stepped:
            self._ripples.gather()

    def force(self) -> Array:
        tangent = self.contact.surface.tangent(*self.contact.place(self._unknowns.state))
        return np.array([self._integral(self.slip.Get() * t * self._limit()) for t in tangent])

    def heat(self, way: float) -> float:
        """``way |slip| int mu P dA``."""
        return way * abs(self.slip.Get()) * self._integral(self._limit())

    def margin(self) -> float:
        """Least Re f over the contact (see ``Ripples``) [-]: below 0 steady sliding is unstable; nan out of contact."""
        return math.nan if self._ripples is None else self._ripples.margin(self.slip.Get() * self.mu())

    def _limit(self) -> Any:
        """Nominal traction mu P of the present state [MPa]."""
        return self.mu() * self._unknowns.state[self.contact.pressure_name]
