"""Stabilisation of sliding contacts: the friction of pressure ripples acts a quarter of an element downstream."""

from __future__ import annotations

import math

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Unknowns
from ngwear.effects.contact import OutlineContact

SHIFT = 0.25  # of a mesh edge; an eighth of a wave of two edges; settled on the sliding roller (``verify``)
TOUCHING = 1e-2  # of the highest pressure: what counts as contact; below, a mesh edge at its end says little


class Ripples:
    """Ripples P - P_s of a contact's pressure P about a smooth one P_s, whose friction acts downstream.

    Friction of the ripple P - P_s acts at ``x + SHIFT h`` instead of x, in the direction in which it drags the rubber;
    h is the length of the mesh edge. In weak form the virtual displacement v there is ``v - SHIFT h dv/ds``. The
    resultant is as before, a smooth pressure is not touched, and what a coarse mesh changes shrinks with h^3. P_s is
    the nodal pressure, averaged over neighbours so that waves of two edges vanish and cubics stay. It follows the
    present state in each residual; the tangent takes it as given.

    Why: a half-plane of shear modulus G (neo-Hooke, incompressible, plane strain), stretched along its surface by
    lambda under p and mu p, slides on a rigid plane. Let a wave of wavenumber k displace its surface along itself by u.
    The tractions then change by

        dt - mu dp = G k u f,    f = 1 + 1/lambda^2 - mu^2 p/G - i mu (p/G + 1/lambda^2 - 1)

    (Biot's incremental equations, ``test_ripples.py``). While Re f > 0 Galerkin's method is stable at every
    wavelength. Where Re f <= 0 an equilibrium may still exist, but a wave grows as it runs, by any damping of the
    rubber, and discrete pressures wrinkle at the mesh's wavelength; in practice from Re f of 0.4 to 0.6 on. To take the
    friction from the pressure a way d further downstream turns the last term by the phase k d and makes it a positive
    real part. Upstream it is a negative one: without convergence from mu = 0.7 on.

    ``moved`` is the density of P - P_s times what the shift takes off the virtual displacement along the surface's
    tangent.
    """

    def __init__(self, contact: OutlineContact, unknowns: Unknowns) -> None:
        self._contact, self._unknowns = contact, unknowns
        self._smooth = ng.GridFunction(unknowns.state[contact.pressure_name].space)
        along = ng.specialcf.tangential(2)
        ahead = along + ng.Grad(unknowns.state[DISPLACEMENT]) * along  # its sign has no tangent
        tangent = contact.surface.tangent(*contact.place(unknowns.trial))
        way = ng.IfPos(ahead[0] * tangent[0] + ahead[1] * tangent[1], 1.0, -1.0)
        shift = SHIFT * contact.lengths(unknowns) * way
        change = ng.Grad(unknowns.v).Trace() * along
        virtual = change[0] * tangent[0] + change[1] * tangent[1]
        self.moved = (unknowns.trial[contact.pressure_name] - self._smooth) * shift * virtual

    def gather(self) -> None:
        """Take P_s from the present state."""
        nodes, nodal = self._contact.nodes, self._contact.nodal_pressure()
        if not nodal.any():
            self._smooth.vec[:] = 0.0
            return

        def averaged(nodal: Array) -> Array:
            return nodes.average(np.repeat(nodal[nodes.of_edges].mean(axis=1), 2))

        smooth = self._contact.pressure_vector(averaged(2 * nodal - averaged(nodal))[nodes.of_edges])
        self._smooth.vec.FV().NumPy()[:] = smooth

    def margin(self, mu: ng.CoefficientFunction) -> float:
        """Least Re f over the mesh edges that touch, under a friction mu [-]; not a number out of contact."""
        state, contact = self._unknowns.state, self._contact
        u, nominal = state[DISPLACEMENT], state[contact.pressure_name]
        stretch = self._unknowns.kinematics.area_stretch(u, ng.Grad(u))
        left = contact.sample_middles(1 + 1 / stretch**2 - mu * mu * nominal / (stretch * contact.modulus))
        pressure = contact.sample_middles(nominal)
        touching = pressure > max(TOUCHING * pressure.max(), 0.0)
        return float(left[touching].min(initial=math.inf)) if touching.any() else math.nan
