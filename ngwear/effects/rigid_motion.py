"""A part with room to move: springs in the tangent let it find the wall that stops it."""

from __future__ import annotations

from collections.abc import Sequence

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array, Term, Unknowns
from ngwear.effects.contact import OutlineContact
from ngwear.effects.rounding import Rounding

# Of G / L. Far below the stiffness of a wall, and of a ring that rolls (about 1e-2), so that an iteration leaves little
# of the error; far above rounding.
STIFFNESS = 1e-4
# Of the last correction over L: the strength in the second attempt. Springs as stiff as the part for corrections of a
# tenth of L, which vanish with them. Of 32 sections (``tests/stability/foreign.py``, 16 each of seeds 0 and 1) all
# were mounted with 1e3 and 1e4, in 2,800 and 2,700 iterations, and 31 without.
FOLLOWS, LARGEST, FIRST = 1e4, 0.1, 0.01
FARTHEST = 2.0  # of the section's size L: a translation in one iteration


class RigidMotion(Term):
    """Springs between the outline and the present iterate, in the directions in which nothing holds the part.

    Each Newton iteration adds ``k int (u - u_now) . v dS`` with ``k = STIFFNESS G / L`` and the present iterate
    ``u_now``: a proximal step (Rockafellar, SIAM J. Control Optim. 14 (1976) 877). The tangent is regular while the
    part is free to move, and the residual has no share of the springs at any time, so that the equilibrium is the one
    without them. A free part that a load drives moves until an edge of it lies a mesh edge deep in a surface; the
    next iteration finds the force there. A part that a load drives and nothing stops does not converge.

    Parameters
    ----------
    directions : sequence of int
        Components of the displacement in which nothing holds the part.
    contacts : sequence of OutlineContact
        What may stop it; they come before this term in the problem's list.
    modulus : float
        Shear modulus G of the part [MPa].

    Attributes
    ----------
    strength : ng.Parameter
        Factor of k, 1 at first. In the second attempt of a solve it grows with the last correction: with stick, slip
        and contact still unsettled, a ring may roll far in one iteration. There, too, points that have just touched
        slip first (``UnilateralContact.new_points_slip``).
    """

    def __init__(self, directions: Sequence[int], contacts: Sequence[OutlineContact], *, modulus: float) -> None:
        super().__init__()
        self.directions, self.contacts, self.modulus = tuple(directions), tuple(contacts), modulus
        self.strength = ng.Parameter(1.0)
        self._second = False
        self._hold = ng.Parameter(0.0)
        for contact in self.contacts:
            contact.rounding, contact.only_near = Rounding(modulus), True

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        u, v = unknowns.u, unknowns.v
        self._state = unknowns.state[DISPLACEMENT]
        self._now = ng.GridFunction(self._state.space)
        self._size = unknowns.body.size
        stiffness = STIFFNESS * self.modulus / self._size
        self._held_at = ng.GridFunction(self._state.space)
        free = self.strength * stiffness * sum((u[i] - self._now[i]) * v[i] for i in self.directions)
        held = self._hold * self.modulus / self._size * sum((u[i] - self._held_at[i]) * v[i] for i in range(2))
        form += (unknowns.kinematics.weight * (free + held)).Compile() * ng.ds
        self._shift = []
        for i in self.directions:
            self._now.Set(ng.CF(tuple(1.0 if k == i else 0.0 for k in range(2))))
            self._shift.append(self._now.vec.FV().NumPy().copy())

    def attempt(self, number: int) -> bool:
        self._second = number > 0
        self.strength.Set(FOLLOWS * FIRST if self._second else 1.0)
        for contact in self.contacts:
            contact.new_points_slip.Set(float(self._second))
        return True

    def hold_back(self, strength: float) -> bool:
        self._hold.Set(strength)
        self._held_at.vec.data = self._state.vec
        return True

    def gather(self) -> None:
        self._now.vec.data = self._state.vec

    def limit(self, correction: Array) -> None:
        """Shorten the mean translation of a correction to where the part meets a surface, in place.

        ``correction`` is of the displacement's unknowns and is to be subtracted.
        """
        means = [float(correction @ shift) / float(shift.sum()) for shift in self._shift]
        way = np.zeros(2)
        way[list(self.directions)] = [-mean for mean in means]
        share = min([1.0, *(self._free_share(contact, way) for contact in self.contacts)])
        for mean, shift in zip(means, self._shift, strict=True):
            correction -= (1 - share) * mean * shift
        if self._second:
            moved = float(np.abs(correction).max()) / self._size
            self.strength.Set(max(1.0, FOLLOWS * min(LARGEST, moved)))

    def _free_share(self, contact: OutlineContact, way: Array) -> float:
        """Share of a translation [mm] after which the contact's edges lie a mesh edge deeper in its surface."""
        length = float(np.linalg.norm(way))
        place = contact.vertices_in_frame().reshape(2, -1)
        floor = np.minimum(contact.surface.gap(*place), 0.0) - contact.finest
        share, most = 0.0, min(1.0, FARTHEST * self._size / length) if length > 0 else 1.0
        while share < most:  # the gap is a distance: a step of this length does not pass the surface
            room = float((contact.surface.gap(*(place + share * way[:, None])) - floor).min())
            if room < 1e-2 * contact.finest:
                return share
            share += room / length if length > 0 else most
        return most
