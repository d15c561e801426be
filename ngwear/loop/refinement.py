"""Element sizes: fine in the refined contacts, and where the error indicator of the stresses is too large."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.geometry.body import Body
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import SizeField, smoothed
from ngwear.loop.stage import Stage
from ngwear.scene.contact import Contact
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]

# These were settled on the rod seal, by its depth's error and its elements (adaptive_against_fixed.py), TURN besides on
# an O-ring that could not be meshed with few elements: see the list in tests/benchmarks/README.md.
FINER = 0.7  # of the size that the contacts ask for: what the indicator must fall below to be heard
NARROWEST = 0.25  # of the patch: elements of the narrowest bumps
MOST = 0.7  # of the largest wear rate: from there on a stroke's own patch counts. Settled on two U-cups: see that list
NEAR, NEARER = 2.0, 1.0  # patches: gaps that may close soon, and sooner
LEAST = 0.5  # of these: also where wear has not so much left to close
TURN, WIDEST_TURN = 0.5, 0.7  # rad, of the outline between nodes off the contacts; with few elements across
FEW = 4.0  # elements across; with two more all follow the outline as closely as they ever do
CONTACT_SLACK, STRESS_SLACK = 1.5, 2.0  # how much too long elements may be before a new mesh is due


def required_sizes(
    stage: Stage,
    phases: list[Array],
    *,
    across: float | None = None,
    worn: bool = False,
    fine: Array | None = None,
    reach: float = NEAR,
    sliding: float = 0.0,
    left: float = math.inf,
) -> SizeField:
    """Required element sizes for the present states, one state for each stroke of the cycle.

    In the contacts those of ``contact_sizes``; elsewhere the size at which the error indicator of an element is its
    share of ``Accuracy.stress_error``. ``worn`` as there. ``fine``, shape (k, 3): places and sizes that solves have
    asked for.
    """
    contacts = contact_sizes(stage, phases, across=across, worn=worn, reach=reach, sliding=sliding, left=left)
    places, sizes = _stress_sizes(stage, phases)
    heard = sizes < FINER * contacts(places)
    field = replace(
        contacts,
        seeds=np.vstack([contacts.seeds, places[heard]]),
        sizes=np.concatenate([contacts.sizes, sizes[heard]]),
    )
    if fine is None or len(fine) == 0:
        return field
    return replace(
        field,
        seeds=np.vstack([field.seeds, fine[:, :2]]),
        sizes=np.append(field.sizes, fine[:, 2]),
    )


def is_too_coarse(stage: Stage, phases: list[Array], *, sliding: float = 0.0, left: float = math.inf) -> bool:
    """Whether a refined contact, or a stress concentration, has reached elements that are much too coarse.

    Gaps count up to half of the width for which ``contact_sizes`` refines, so that a new mesh is not too coarse at
    once.
    """
    body = stage.body
    if not isinstance(body, Body):  # a scene that deactivates elements is not remeshed
        return False
    wanted = required_sizes(stage, phases, reach=NEARER, sliding=sliding, left=left)
    slack = np.where(wanted.sizes > stage.scene.accuracy.lengths.patch, STRESS_SLACK, CONTACT_SLACK)
    return bool(np.any(body.field(wanted.seeds) > slack * wanted.sizes))


def contact_sizes(
    stage: Stage,
    phases: list[Array],
    *,
    across: float | None = None,
    worn: bool = False,
    reach: float = NEAR,
    sliding: float = 0.0,
    left: float = math.inf,
) -> SizeField:
    """Element sizes for the contacts alone.

    The size is ``patch`` where a refined contact carries load, where its gap is below ``reach`` times ``patch``, or
    where wear over a sliding distance of ``sliding`` [mm] may close the gap. The gap limit is smaller, down to half, if
    the remaining sliding distance ``left`` [mm] wears less than ``NEAR`` times ``patch``.
    With ``across``, narrow bumps of pressure have smaller elements, this number across each, down to ``NARROWEST``
    times ``patch``; in the strokes that wear the most (``MOST``), times what the contact's own width there gives: a lip
    wears at its tip in one stroke, and lies flat in another that bears more.
    On an outline that has ``worn`` they have none smaller than now, and none smaller for the outline's curvature: it
    has points for these only, and between them finer elements find peaks that are none.

    Wear spreads a contact and lowers its pressures, so that the present wear rate is an upper bound of later ones.

    If the leak pressure is computed, the size is ``patch`` also where the fluid meets any contact.
    """
    lengths, contour = stage.scene.accuracy.lengths, stage.body.contour
    size, fronts = np.full(len(contour), np.inf), [np.empty((0, 2))]
    vector = stage.problem.state.vec.FV().NumPy()
    keep = vector.copy()
    found: list[tuple[ContactProfile, float]] = []  # and the largest wear over the sliding distance [mm/mm]
    for phase in phases:
        vector[:] = phase
        for spec in stage.scene.followed:
            contact = stage.contacts[spec.name]
            profile = contact.profile()
            wearing = profile.nominal_pressure * contact.wear_factor(profile.pressure)
            found.append((profile, spec.wear_rate.highest * float(wearing.max(initial=0.0))))
        fronts += [_beside(contour, fluid.fronts(), lengths.patch) for fluid in stage.leaking]
    vector[:] = keep
    largest = max((rate for _, rate in found), default=0.0)
    for profile, rate in found:
        deepest = rate * left if rate > 0 else 0.0
        soon = reach * min(lengths.patch, max(LEAST * lengths.patch, deepest / NEAR)) + rate * sliding
        patch = element_edges(profile, lengths.patch, across, worn=worn, narrow=0 < MOST * largest <= rate)
        near = (profile.nominal_pressure > 0) | (profile.gap < soon)
        beside = (profile.nominal_pressure == 0) & (profile.gap >= reach * patch)
        patch = np.where(beside, np.maximum(patch, NARROWEST * lengths.patch), patch)
        ask = _spanned(contour, profile, near)
        size[ask] = np.minimum(size[ask], np.interp(np.flatnonzero(ask), profile.t, patch, period=len(contour)))
    ask, places = size < np.inf, np.vstack(fronts)
    seeds, sizes = np.vstack([contour.points[ask], places]), np.append(size[ask], np.full(len(places), lengths.patch))
    turn = TURN if across is None else min(TURN * max(1.0, FEW / across), WIDEST_TURN)
    return SizeField(
        seeds,
        sizes,
        lengths.coarse,
        lengths.grading,
        elsewhere=turn,
        per_radius=0.0 if worn else _per_radius(across),
        finest=lengths.patch,
    )


def _per_radius(across: float | None) -> float:
    """Least number of element edges per radius of curvature of the outline; smaller for few elements across.

    With 2, Netgen's default, the shipped rod seal with 2.5 across has a fourth more elements, all outside contacts.
    """
    return 2.0 if across is None else float(np.clip(across / 2 - 1.0, 1.0, 2.0))


def _beside(contour: Outline, t: Array, apart: float) -> Array:
    """Places of the outline at parameters t, and at the distance ``apart`` [mm] on both sides, shape (3 len(t), 2)."""
    points = np.arange(len(contour) + 1)
    ways = np.concatenate([[0.0], np.cumsum(contour.lengths)])
    there = np.interp(t, points, ways)[:, None] + apart * np.array([-1, 0, 1])
    return contour.at(np.interp(there.ravel() % ways[-1], ways, points))


def element_edges(
    profile: ContactProfile, patch: float, across: float | None, *, worn: bool = False, narrow: bool = False
) -> Array:
    """Element edge at each node of a contact, by the bump's width at the nearest loaded one, shape (k,) [mm].

    ``worn`` as in ``contact_sizes``. ``narrow``: the least edge is a share of what the contact's own width gives, if
    that is less than ``patch``.
    """
    if across is None or not (widths := profile.bump_widths()).any():
        return np.full(len(profile.t), patch)
    narrowest = NARROWEST * patch
    if narrow:
        loads, wide = np.transpose(profile.loads_and_widths())
        narrowest = NARROWEST * min(patch, float(np.average(wide, weights=loads)) / across)
    loaded = np.flatnonzero(widths)
    nearest = np.abs(profile.t[:, None] - profile.t[loaded]).argmin(axis=1)
    least = np.clip(profile.shortest_edges, narrowest, patch) if worn else narrowest
    return np.clip(widths[loaded][nearest] / across, least, patch)


def _stress_sizes(stage: Stage, phases: list[Array]) -> tuple[Array, Array]:
    """Centres of the elements, shape (m, 2), and the element edge that their stress error requires, shape (m,) [mm].

    The stress is compared with its continuous recovery at the nodes (Zienkiewicz & Zhu, Int. J. Numer. Methods Eng. 24
    (1987) 337): eta^2 = int |P - P*|^2 / 2G dV. With N elements of equal error each may have eta = stress_error
    sqrt(energy / N). The error is proportional to the element edge to the power of the displacement's order. For order
    1 the power 2 is used, and several meshes are needed: if few elements are refined, N hardly changes and their error
    falls with the square (7,000 elements on the shipped shaft, 8,800 with the first power). A tolerance of 1 requires
    nothing.
    """
    accuracy = stage.scene.accuracy
    tolerance = accuracy.tolerances.stress_error
    if tolerance == 1:
        return np.empty((0, 2)), np.empty(0)
    points, elasticity = stage.problem.points, stage.elasticity
    points.follow()
    edge, power = np.full(len(points.volumes), np.inf), 1 / max(elasticity.order, 2)
    for phase in phases:
        strain = points.strain(phase)
        stress, _ = elasticity.response(strain, tangent=False)
        off = stress[..., :5] - points.recovered(stress[..., :5])
        error = np.sqrt((points.volumes * (off**2).sum(axis=-1)).sum(axis=1) / (2 * elasticity.material.shear_modulus))
        energy = (points.volumes * elasticity.energy(strain)).sum()
        if energy <= 0.0:  # an unloaded part requires nothing; rounding may leave less than nothing
            continue
        share = tolerance * np.sqrt(energy / len(edge))
        edge = np.minimum(edge, points.edges * (share / np.maximum(error, 1e-12 * share)) ** power)
    return points.centres, np.maximum(edge, accuracy.lengths.patch)


def _spanned(contour: Outline, profile: ContactProfile, near: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mask of outline points at marked nodes, and between two of them that a mesh edge joins."""
    n = len(contour)
    ask = np.zeros(n, dtype=bool)
    ask[np.rint(profile.t[near]).astype(int) % n] = True
    for i, j in profile.edges[near[profile.edges].all(axis=1)]:
        a, b = profile.t[i], profile.t[j]
        b = b if b > a else b + n
        ask[np.arange(np.floor(a), np.ceil(b) + 1).astype(int) % n] = True
    return ask


def unworn_outline(scene: Scene) -> Outline:
    """The scene's outline, resampled for elements of edge ``patch`` on the edges that wear."""
    return smoothed(scene.part.outline, scene.worn_edges, 1.3 * scene.accuracy.lengths.patch)


def mounting_field(scene: Scene, across: float | None = None) -> SizeField:
    """Element sizes for mounting: fine at curved edges of refined contacts.

    ``across`` is ``Accuracy.across`` of a scene whose lengths come from it, else None.
    """
    lengths, contour = scene.accuracy.lengths, scene.part.outline
    curved = np.abs(contour.turning) > 1e-3
    mine = np.zeros(len(contour), dtype=bool)
    for spec in scene.followed:
        on = contour.on(spec.edges)
        mine |= on | np.roll(on, 1)
    seeds = contour.points[mine & curved & ~contour.corners]
    for spec in scene.followed:
        if len(seeds) == 0 or spec.force is not None:
            seeds = np.vstack([seeds, _nearest_place(scene, spec)])
    sizes, grading = np.full(len(seeds), lengths.mounting), max(lengths.grading, 0.3)
    return SizeField(seeds, sizes, lengths.coarse, grading, turn=0.5, per_radius=_per_radius(across))


def _nearest_place(scene: Scene, spec: Contact) -> Array:
    """Place on the edges that is nearest to the surface, shape (1, 2) [mm]."""
    contour = scene.part.outline
    t = np.concatenate([i + np.linspace(0, 1, 201)[:-1] for i in np.flatnonzero(contour.on(spec.edges))])
    places = contour.at(t)
    return places[[int(np.argmin(spec.surface.gap(*places.T)))]]
