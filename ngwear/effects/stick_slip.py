"""Coulomb friction with stick and slip: for reversals, partial slip, and surfaces at rest."""

from __future__ import annotations

from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Unknowns
from ngwear.effects.friction import Friction
from ngwear.effects.rounding import Rounding
from ngwear.effects.unilateral import UnilateralContact
from ngwear.geometry.meshed import Meshed
from ngwear.laws import FrictionLaw

# It changes the way to the solution only, see ``_laws``; checked by ``verify partial_slip`` and ``tests/stability``.
RETURN = 0.1  # of mu P: how far a turned slip takes a sliding point back below its limit
AT_WILL = 1e6  # of mu P: no limit to it
MIDDLES = {ng.SEGM: ng.IntegrationRule(ng.SEGM, 1), ng.TRIG: ng.IntegrationRule(ng.TRIG, 1)}
NOTHING = 1e-9  # of G: a pressure that rounding leaves where there is no contact


class StickSlip(Friction):
    """Coulomb's law over one step, from the state of the last accepted one; the nominal traction T is an unknown.

        |T| <= mu P,   s = 0 where |T| < mu P,   else T = - mu P s / |s|

    with the step's slip ``s = t . (x - x_0) - (travel - travel_0)`` along the surface's unit tangents t: x is X + u in
    the frame of the moving surface, and the load ``"NAME travel [mm]"`` what the surface has moved along itself
    (a rod that slides, a shaft that turns). One traction for each tangent.

    Newton's method is an active set for P, s and T together (Alart & Curnier, Comput. Methods Appl. Mech. Eng. 92
    (1991) 353); its tangent is consistent and unsymmetric. Only ``commit``, after an accepted step, updates the
    history. In the problem's list the contact must come before this term.

    Parameters and errors as of ``Friction``; the coefficient's distance and speed are those of the step.
    """

    remembers = True

    def __init__(self, contact: UnilateralContact, law: FrictionLaw | float, *, speed: float | None = None) -> None:
        super().__init__(contact, law, speed=speed)
        self.travel = ng.Parameter(0.0)
        self._travel_before = ng.Parameter(0.0)
        self.loads = {f"{contact.name} travel [mm]": self.travel}
        self._motion_before = [ng.Parameter(0.0) for _ in contact.surface.approach]
        self.tractions = tuple(f"{contact.name} traction {k + 1}" for k in range(len(self._motion_before) - 1))
        contact.slips_in_part = True
        self._spent: float = 0.0
        self._slid: Array | float = 0.0

    def spaces(self, body: Meshed) -> dict[str, ng.FESpace]:
        region = body.boundary(self.contact.edges)
        space = ng.Compress(ng.SurfaceL2(body.mesh, order=0, definedon=region))
        return dict.fromkeys(self.tractions, space)

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        contact, body, weight = self.contact, unknowns.body, unknowns.kinematics.weight
        self._unknowns = unknowns
        self._before = ng.GridFunction(unknowns.state[DISPLACEMENT].space)
        give = contact.lengths(unknowns) / contact.modulus
        tangents = contact.surface.tangents(*contact.place(unknowns.trial))
        tractions = [unknowns.trial[name] for name in self.tractions]
        p = unknowns.trial[contact.pressure_name] - NOTHING * contact.modulus
        stretch = unknowns.kinematics.area_stretch(unknowns.u, ng.Grad(unknowns.u).Trace())
        bound = self.coefficient(p / stretch) * ng.IfPos(p, p, 0.0)
        again = ng.IfPos(contact.new_points_slip, bound * AT_WILL, RETURN * bound)
        slips = self._slips(unknowns.trial, tangents)
        laws = _laws(tractions, slips, bound=bound, give=give, again=again)
        if contact.rounding is not None and len(laws) == 1:
            bound = self.coefficient(p / stretch) * contact.rounding.positive(p)
            rounded = _rounded_law(tractions[0], slips[0], bound=bound, give=give, rounding=contact.rounding)
            laws = [contact.rounding.choose(rounded, laws[0])]
        virtual = contact.virtual(unknowns)
        work = sum(a * sum(t[i] * v for i, v in enumerate(virtual)) for a, t in zip(tractions, tangents, strict=True))
        tests, region = [unknowns.test[name] for name in self.tractions], body.boundary(contact.edges)
        if contact.where_near:  # everywhere else it is the law of no traction
            nothing = [0.5 * give * traction for traction in tractions]
            rest = sum(none * test for none, test in zip(nothing, tests, strict=True))
            form += (rest * weight).Compile() * ng.ds(definedon=region, intrules=MIDDLES)
            laws = [law - none for law, none in zip(laws, nothing, strict=True)]
        form += (-work * weight).Compile() * ng.ds(definedon=region, bonus_intorder=2, **contact.where_near)
        law = sum(law * test for law, test in zip(laws, tests, strict=True))
        form += (law * weight).Compile() * ng.ds(definedon=region, intrules=MIDDLES, **contact.where_near)

    def _slips(self, fields: dict[str, Any], tangents: tuple[tuple[Any, ...], ...]) -> list[ng.CoefficientFunction]:
        """Slip along each tangent since the last accepted state [mm]."""
        u, motion = fields[DISPLACEMENT], self.contact.motion(fields)
        passed = [u[i] - self._before[i] - m + self._motion_before[i] for i, m in enumerate(motion)]
        slips = [sum(d * t[i] for i, d in enumerate(passed)) for t in tangents]
        slips[0] = slips[0] - (self.travel - self._travel_before)
        return slips

    def begin(self) -> None:
        """Start a stroke at the present state: slip, distance and heat are counted from here."""
        self.travel.Set(0.0)
        self._count_from_here()
        self._spent, self._slid = 0.0, 0.0

    def commit(self, strain: Array) -> None:
        self._count_from_here()

    @property
    def counted(self) -> tuple[float, float | Array]:
        """Heat and slip since the stroke began, up to the last equilibrium."""
        return self._spent, self._slid

    def go_back(self, counted: tuple[float, float | Array]) -> None:
        """Count on from the present state, an earlier equilibrium of the stroke at which so much was ``counted``."""
        self._count_from_here()
        self._spent, self._slid = counted

    def _count_from_here(self) -> None:
        """Count the slip of the next step from the present state."""
        self._spent, self._slid = self.heat(0.0), self.slid()
        state, contact = self._unknowns.state, self.contact
        self._before.vec.data = state[DISPLACEMENT].vec
        self._travel_before.Set(self.travel.Get())
        for parameter, value in zip(self._motion_before, contact.stands(), strict=True):
            parameter.Set(value)

    def force(self) -> Array:
        state = self._unknowns.state
        tangents = self.contact.surface.tangents(*self.contact.place(state))
        pairs = list(zip(self.tractions, tangents, strict=True))
        return np.array(
            [self._integral(sum(state[n] * t[i] for n, t in pairs)) for i in range(len(self._motion_before))]
        )

    def heat(self, way: float) -> float:
        """``- int T . s dA`` of the slip s since the stroke began, independent of ``way``."""
        state = self._unknowns.state
        slips = self._slips(state, self.contact.surface.tangents(*self.contact.place(state)))
        return self._spent - self._integral(sum(state[n] * s for n, s in zip(self.tractions, slips, strict=True)))

    def slid(self) -> Array:
        """Slip distance of each surface element's middle since the stroke began [mm], in the contact's order."""
        state = self._unknowns.state
        slips = self._slips(state, self.contact.surface.tangents(*self.contact.place(state)))
        return self._slid + self.contact.sample_middles(ng.sqrt(sum(s * s for s in slips)))


def _laws(
    tractions: list[ng.CoefficientFunction],
    slips: list[ng.CoefficientFunction],
    *,
    bound: ng.CoefficientFunction,
    give: ng.CoefficientFunction,
    again: ng.CoefficientFunction,
) -> list[ng.CoefficientFunction]:
    """Residual for each tangent [mm]: the slip where it sticks, the traction minus its limit where it slips.

    A point sticks if ``|T - d| < mu P``, where d is the traction ``2 s / give`` of the slip. If T is near its limit, d
    is at most a tenth of mu P: a point whose slip direction changes must stick before it slips the other way, or
    Newton's method alternates between the two. Else d is at most ``again``, the same tenth or no limit: a point that
    has just touched has slipped by s, but has no T yet. With the tenth it sticks first and must go back by s, whatever
    little pressure it has, which may never end; without a limit it slips first, so that nothing holds a part that has
    just touched. The tractions are constant on each mesh edge or face and the law holds in its middle: with one unknown
    at each end there would be as many of them as displacements of order 2, and the tractions oscillate.
    """
    stiff = 2 / give
    if len(tractions) == 1:
        (traction,), (slip,) = tractions, slips
        held = (1 - RETURN) * bound
        most = ng.IfPos(held - traction, ng.IfPos(held + traction, again, RETURN * bound), RETURN * bound)
        turned = traction - ng.IfPos(stiff * slip - most, most, ng.IfPos(-most - stiff * slip, -most, stiff * slip))
        sticks = ng.IfPos(bound - turned, ng.IfPos(bound + turned, 1.0, 0.0), 0.0)
        slides = (traction - ng.IfPos(turned, bound, -bound)) / stiff
        return [ng.IfPos(sticks, slip + 1e-6 * give * traction, slides)]
    size = ng.sqrt(sum(s * s for s in slips) + 1e-30)
    least = ng.IfPos(stiff * size - RETURN * bound, RETURN * bound / size, stiff)
    turned = [t - least * s for t, s in zip(tractions, slips, strict=True)]
    length = ng.sqrt(sum(t * t for t in turned) + 1e-30)
    return [
        ng.IfPos(bound - length, s + 1e-6 * give * t, (t - bound * a / length) / stiff)
        for t, s, a in zip(tractions, slips, turned, strict=True)
    ]


def _rounded_law(
    traction: ng.CoefficientFunction,
    slip: ng.CoefficientFunction,
    *,
    bound: ng.CoefficientFunction,
    give: ng.CoefficientFunction,
    rounding: Rounding,
) -> ng.CoefficientFunction:
    """``(T - t) give / 2`` [mm], where t is the trial traction ``T - 2 s / give`` cut off at both limits, rounded."""
    trial = traction - 2 / give * slip
    beyond = rounding.positive(trial - bound) - rounding.positive(-trial - bound)
    return slip + 0.5 * give * beyond + 1e-6 * give * traction
