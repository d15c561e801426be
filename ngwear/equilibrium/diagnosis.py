"""Diagnosis of a failed load step from its last equilibrium: a part that is not held, or rolls; an unstable surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import DISPLACEMENT, Array
from ngwear.effects.contact import OutlineContact
from ngwear.effects.rigid_motion import RigidMotion
from ngwear.effects.unilateral import UnilateralContact
from ngwear.equilibrium.problem import Problem
from ngwear.fields.deformed_outline import crossing, outline_places, stretches
from ngwear.geometry.meshed_section import MeshedSection

if TYPE_CHECKING:  # imported only if there is friction
    from ngwear.effects.friction import Friction

# Above what rounding leaves, far below what any support or contact brings; checked by ``tests/stability`` (sealing.py).
FREE = 1e-9  # stiffness of a rigid motion over what its nodes would feel one by one, below which nothing holds it
# Least principal stretch of a free surface in plane strain: creases (Hong et al., Appl. Phys. Lett. 95 (2009) 111901)
# and wrinkles (Biot, Appl. Sci. Res. A 12 (1963) 168).
CREASING, WRINKLING = 0.65, 0.544
REMEDIES = "lower the friction or the load, use smaller steps, or a stiffer rubber"
UNFOLD = "lower the load, take a stiffer rubber, or round the section there"
ROLLS_OVER = (
    "friction rolls the part over, and no state is left in which it only slides: lower the friction where the part "
    "slides, or give it less room along the axis"
)
ROLLS = 45.0  # degrees: a ring resists turning with a moment that grows less and less, up to a quarter of a turn
CRUSHED = 0.5  # J of an element; rubber bears far less compression
COLLAPSED = 0.1  # J of an element: no shorter load step leads on from there; rubber bears no such compression
NEAR = 1.03  # times the creasing stretch: the last equilibrium counts as near it up to here


def diagnosis(problem: Problem) -> str:
    """Sentences for the message of a failed load step; empty if no cause is found."""
    found = [_unheld(problem), _unstable_surface(problem)]
    return "".join(f"\n{sentence}" for sentence in found if sentence)


def folds(problem: Problem) -> str:
    """Sentence for the same message: where the outline of a section crosses itself, is creased or crushed; or empty.

    Other than what ``diagnosis`` finds it may be due to elements that are too coarse.
    """
    if not isinstance(problem.body, MeshedSection):
        return ""
    before, after = outline_places(problem.body, problem.fields[DISPLACEMENT])
    at = crossing(after)
    if at is not None:
        return f"\n{crosses(at)}: {UNFOLD}"
    stretch = stretches(before, after)
    if stretch.min() <= NEAR * CREASING:
        half, edge = np.unravel_index(np.argmin(stretch), stretch.shape)
        x, y = after[half, edge]
        name, least = problem.body.outline.names[edge], stretch[half, edge]
        return (
            f"\nthe load folds the surface: edge '{name}' is compressed to {least:.2g} of its length at "
            f"({x:.4g}, {y:.4g}); it creases from {CREASING}: {UNFOLD}"
        )
    jacobians = problem.jacobians()
    if jacobians.min() < CRUSHED:
        x, y = problem.points.centres[jacobians.argmin()]
        return (
            f"\nan element at ({x:.4g}, {y:.4g}) of the undeformed section is squeezed to {jacobians.min():.2g} of its "
            "volume: the mesh does not resolve the section there; take smaller elements"
        )
    return ""


def crosses(at: tuple[float, float]) -> str:
    """Says that an outline crosses itself at a place."""
    x, y = at
    return f"the outline crosses itself at ({x:.4g}, {y:.4g}): the part touches itself there, which is not computed"


def _unheld(problem: Problem) -> str:
    """Rigid motions of the part, and surfaces under force, that no support, contact or stress resists."""
    for term in problem.terms:
        if isinstance(term, RigidMotion):
            term.strength.Set(0.0)
    matrix, vector = problem.assemble(), problem.state.vec
    for term in problem.terms:
        if isinstance(term, RigidMotion):
            term.strength.Set(1.0)
    held = ~np.fromiter(problem.free, dtype=bool, count=len(vector))
    diagonal = np.abs(np.array([matrix[i, i] for i in range(len(vector))]))
    contacts = [t for t in problem.terms if isinstance(t, UnilateralContact) and t.force_controlled]
    motion, product = vector.CreateVector(), vector.CreateVector()

    def free(values: Array) -> bool:
        if np.abs(values[held]).max(initial=0.0) > 1e-9 * np.abs(values).max():
            return False
        motion.FV().NumPy()[:] = values
        product.data = matrix * motion
        return abs(values @ product.FV().NumPy()) <= FREE * (diagonal @ values**2)

    travels = []
    for contact in contacts:
        values = np.zeros(len(vector))
        values[problem.part(contact.travel_name)] = 1.0
        if diagonal @ values == 0 or free(values):
            travels.append(f"surface '{contact.name}' under force touches nothing")
    directions = []
    for name, values in _rigid_motions(problem):
        along = values.copy()  # the surfaces under force move with the part
        for contact in contacts:
            i = "xyz".find(name[-1])
            along[problem.part(contact.travel_name)] = contact.surface.approach[i] if name[:-1] == "along " else 0.0
        if free(values) or free(along):
            directions.append(name)
    if directions:
        rest = " (its contacts slip, or are open)" if has_room(problem) else ""
        ways = " and ".join(directions)
        travels.append(f"nothing holds the part {ways}: add a support or a contact that does{rest}")
    return "; ".join(travels)


def _rigid_motions(problem: Problem) -> list[tuple[str, Array]]:
    """Name and vector of unknowns of each rigid motion of the part as it stands."""
    u = problem.fields[DISPLACEMENT]
    dim = problem.body.mesh.dim
    places = [c + u[i] for i, c in enumerate((ng.x, ng.y, ng.z)[:dim])]
    motions: list[tuple[str, list[Any]]] = []
    for i in range(1 if problem.kinematics.axisymmetric else dim):
        motions.append((f"along {'xyz'[i]}", [1.0 if k == i else 0.0 for k in range(dim)]))
    if not problem.kinematics.axisymmetric:
        for axis, (i, j) in zip("zxy", [(0, 1), (1, 2), (2, 0)][: 1 if dim == 2 else 3], strict=False):
            turn = [ng.CF(0.0)] * dim
            turn[i], turn[j] = -places[j], places[i]
            motions.append((f"against turning about {axis}", turn))
    found = []
    field = ng.GridFunction(u.space)
    for name, motion in motions:
        field.Set(ng.CF(tuple(motion)))
        values = np.zeros(len(problem.state.vec))
        values[problem.part(DISPLACEMENT)] = field.vec.FV().NumPy()
        found.append((name, values))
    return found


def rolls(problem: Problem) -> bool:
    """Whether a part with room to move has been turned so far that it goes on rolling."""
    return has_room(problem) and abs(problem.turned()) >= ROLLS


def has_room(problem: Problem) -> bool:
    """Whether nothing holds the part in some direction."""
    return any(isinstance(term, RigidMotion) for term in problem.terms)


def has_collapsed(problem: Problem) -> bool:
    """Whether an element has lost nearly all of its volume."""
    return bool(problem.jacobians().min() < COLLAPSED)


def creases(problem: Problem, stretch: float = CREASING) -> bool:
    """Whether the surface of a contact with friction is compressed to about this stretch, or more [-]."""
    return any(contact.least_stretch()[0] <= NEAR * stretch for contact, _ in _rubbed(problem))


def _rubbed(problem: Problem) -> list[tuple[OutlineContact, Friction]]:
    """The loaded contacts with friction along an outline."""
    from ngwear.effects.friction import Friction

    found = []
    for term in problem.terms:
        if isinstance(term, Friction) and isinstance(term.contact, OutlineContact) and term.contact.peak() > 0:
            found.append((term.contact, term))
    return found


def _unstable_surface(problem: Problem) -> str:
    """Friction that compresses the surface until it creases, or makes waves grow along it."""
    from ngwear.effects.friction import FullSliding

    found = []
    for contact, term in _rubbed(problem):
        slip = abs(term.slip.Get()) if isinstance(term, FullSliding) else 1.0
        cause = f"friction of {slip * term.mean():.3g} under p/G = {contact.peak() / contact.modulus:.2g} at contact "
        cause += f"'{contact.name}' "
        least, place = contact.least_stretch()
        if least <= NEAR * CREASING:
            at = ", ".join(f"{x:.4g}" for x in place)
            found.append(
                f"{cause}compresses the surface at ({at}) to {least:.2g} of its length; it creases from {CREASING} "
                f"and wrinkles at {WRINKLING}, beyond which no smooth equilibrium is left: {REMEDIES}"
            )
        elif isinstance(term, FullSliding) and term.margin() < 0:
            found.append(
                f"{cause}is more than steady sliding bears: waves grow along the surface as they run (margin "
                f"{term.margin():.2g}): {REMEDIES}"
            )
    return "; ".join(found)
