"""Full sliding friction: the cheap term for strokes much longer than the elastic slip."""

from __future__ import annotations

import ngsolve as ng
import numpy as np

from ngwear.effects.base import Term, Unknowns
from ngwear.effects.unilateral import UnilateralContact
from ngwear.errors import SceneError


class FullSliding(Term):
    """Traction ``mu P`` along the surface's motion everywhere in contact (Coulomb, no stick zone).

    The load ``"NAME slip"`` in [-1, 1] is the direction in which the surface moves along its tangent (the
    surface's normal turned clockwise); values between ramp a reversal. Neglects the stick phase after a
    reversal, whose length is the rubber's tangential deflection. The tangent matrix is unsymmetric.

    A surface under force carries the friction too: the force balances pressure and friction together.

    Parameters
    ----------
    contact : UnilateralContact
    coefficient : float
        mu [-], >= 0.

    Raises
    ------
    SceneError
        For a negative coefficient.
    """

    symmetric = False

    def __init__(self, contact: UnilateralContact, coefficient: float) -> None:
        super().__init__()
        if coefficient < 0:
            raise SceneError(f"contact {contact.name}.friction", coefficient, "must be at least 0")
        self.contact, self.coefficient = contact, coefficient
        self.slip = ng.Parameter(1.0)
        self.loads = {f"{contact.name} slip": self.slip}

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        contact = self.contact
        p = unknowns.trial[contact.pressure_name]
        tangent = contact.surface.tangent(*contact.place(unknowns.trial))
        traction = self.coefficient * self.slip * p * unknowns.kinematics.weight
        virtual = [unknowns.v[i] for i in range(len(tangent))]
        if contact.force_controlled:  # the force carries the friction too
            travel = unknowns.test[contact.travel_name]
            virtual = [v - travel * a for v, a in zip(virtual, contact.surface.approach, strict=True)]
        work = -traction * sum(t * v for t, v in zip(tangent, virtual, strict=True))
        self._unknowns = unknowns
        region = unknowns.body.boundary(contact.edges)
        form += work.Compile() * ng.ds(definedon=region, bonus_intorder=2)

    def force(self) -> np.ndarray:
        """Resultant of the friction on the part; [N], or N/mm in plane strain."""
        tangent = self.contact.surface.tangent(*self.contact.place(self._unknowns.state))
        return np.array([self._integral(self.slip.Get() * t) for t in tangent])

    def drag(self) -> float:
        """``int mu P dA``: heat of the friction over the way that the surface slides; [N], or N/mm in plane strain."""
        return self._integral(1.0)

    def _integral(self, factor: ng.CoefficientFunction | float) -> float:
        """Of the traction ``mu P`` times a factor."""
        known, contact = self._unknowns, self.contact
        traction = self.coefficient * known.state[contact.pressure_name] * known.kinematics.weight
        measure = ng.ds(definedon=known.body.boundary(contact.edges), bonus_intorder=2)
        return float(ng.Integrate(factor * traction * measure, known.body.mesh))
