"""Look at an accepted solve: overlap, zigzag pressures, uneven stretch, imbalance, crushed elements, folds, blow-by.

Every stroke that is recorded is looked at. A finding is a sentence with the place and the value; the run keeps the
worst of each kind and place, and lists them as warnings.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.contact_profile import HALF, NO_PRESSURE, ContactProfile
from ngwear.equilibrium.diagnosis import CRUSHED, crosses
from ngwear.fields.deformed_outline import crossing, outline_places
from ngwear.loop.stage import Stage
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]

DEEP = 0.01  # of the mesh edge there: overlap with a surface
MOST = 0.1  # of what drives an overlap most: eight times less on half the edge
UNLISTED = ", whose edges do not name it: name it there, or give no edges, so that any may touch"
COARSE = ": the mesh there is too coarse for the contact; take smaller elements"
ZIGZAG = 0.1  # of the contact's peak: amplitude of a pressure that alternates from node to node about its course,
UP_AND_DOWN = 0.05  # and of one that goes up and down twice on five nodes; of a stretch that does so on three edges
ALTERNATES = 3  # nodes in a row whose second differences change sign: two bumps on five nodes are not resolved
UNBALANCED = 1e-5  # of the largest force: sum of all forces where no support takes a part of it
BARELY_HELD = "barely held"  # beginning of a key
# What friction does that a part does not bear, and what follows.
ROLLS, CREASES, CRUSHES = "rolls the part over", "creases the surface", "crushes elements"
NO_STATE = "leaves the part no equilibrium that load steps reach"
CONSEQUENCES = {
    ROLLS: "Rolling, it slides less than the travel and wears less; lower the friction where it "
    "slides, or give it less room along the axis",
    CREASES: "Creased, it slides in waves, or tears, and the friction is lower than the law's; lower the "
    "friction or the load, or take a stiffer rubber",
    CRUSHES: "Where it does, the mesh does not resolve the section: take smaller elements, or lower the "
    "friction or the load",
    NO_STATE: "Lower the friction or the load, or take a stiffer rubber",
}


@dataclass(frozen=True)
class Finding:
    """What is wrong with a solve, where, and how much of it.

    Attributes
    ----------
    key : str
        Kind and place: of each, the worst is kept.
    amount : float
        Grows with the fault.
    sentence : str
    places : array, shape (k, 3)
        Where the mesh does not resolve the solve, and the element edge there [mm]; empty for other faults.
    """

    key: str
    amount: float
    sentence: str
    places: Array = field(default_factory=lambda: np.empty((0, 3)), compare=False)


def findings(
    stage: Stage, profiles: Mapping[str, ContactProfile], forces: Mapping[str, Array], stroke: Stroke, *, worn: bool
) -> tuple[Finding, ...]:
    """Findings of the present equilibrium; ``profiles`` and ``forces`` are those of the stroke's report.

    ``worn``: whether the part has worn, or wears in this solve.
    """
    before, place = outline_places(stage.body, stage.problem.fields[DISPLACEMENT])
    found = [
        *_overlaps(stage, before, place, profiles, worn=worn),
        *_crossings(place),
        *_imbalance(stage, forces),
        *_crushed(stage),
        *_useless_inlets(stage, stroke),
        *_blow_by(stage, stroke),
        *_barely_held(stage, stroke),
        *_lower_friction(stage, stroke),
    ]
    for name, contact in stage.contacts.items():
        profile = profiles[name] if name in profiles else contact.profile()
        found += _zigzag(name, profile)
        if contact.wears and not worn:  # a worn outline has corners, at which finer elements only fold
            found += _uneven_stretch(name, profile)
    return tuple(found)


def _overlaps(
    stage: Stage, before: Array, place: Array, profiles: Mapping[str, ContactProfile], *, worn: bool
) -> Iterator[Finding]:
    """Nodes of the whole outline that lie inside a surface, whether its contact lists their edges or not."""
    line = stage.body.outline
    length = np.linalg.norm(np.roll(place[0], -1, axis=0) - place[0], axis=1)
    for name, contact in stage.contacts.items():
        own = np.isin(line.names, contact.edges)
        listed = np.stack([own | np.roll(own, 1), own])  # the node between two edges belongs to both
        gap = _gap(contact, place)
        # In a contact that wears, a solve ends with the depth that it wears inside the surface.
        resting = np.zeros_like(listed) if worn and contact.wears else listed
        for among, advice in ((~listed, UNLISTED), (resting, COARSE)):
            depth = np.where(among, -gap - DEEP * length, 0.0)
            worst = np.unravel_index(np.argmax(depth), depth.shape)
            if depth[worst] > 0:
                edge, (x, y), deep = line.names[worst[1]], place[worst], -float(gap[worst])
                where = f"edge '{edge}' lies {deep:.3g} mm inside the surface of contact '{name}' at ({x:.4g}, {y:.4g})"
                edges = np.broadcast_to(length, depth.shape)
                coarse = (depth > 0) & (advice == COARSE)
                places = np.column_stack([before[coarse], edges[coarse]])
                if coarse.any() and deep < edges[worst]:  # deeper, it is no bulge between nodes
                    places = _driving(profiles[name] if name in profiles else contact.profile(), places)
                yield Finding(f"overlap {name} {edge}", deep, f"{where}{advice}", places)


def _driving(profile: ContactProfile, inside: Array) -> Array:
    """Which mesh edges of a contact push its nodes into the surface, given those that lie inside; as ``places``.

    The pressure is linear on each mesh edge. It does not resist a bulge with all nodes inside by ``a`` and the middles
    of all edges outside by ``a/2``, which only the rubber does, by G a per edge. A pressure of curvature p'' drives it
    by ``p'' h^3`` per edge of length h. So a few long edges bend a whole contact of short ones.
    """
    first, second = profile.edges.T
    apart = profile.reference[second] - profile.reference[first]
    h, p, k = np.linalg.norm(apart, axis=1), profile.pressure, len(profile.t)
    slope = (p[second] - p[first]) / h
    bend = np.abs(np.bincount(first, slope, k) - np.bincount(second, slope, k))
    bend = 2 * bend / (np.bincount(first, h, k) + np.bincount(second, h, k))
    drive = np.maximum(bend[first], bend[second]) * h**3 * ((p[first] > 0) | (p[second] > 0))
    if not drive.any():
        return inside
    most = drive > MOST * drive.max()
    middles = (profile.reference[first] + profile.reference[second])[most] / 2
    return np.column_stack([middles, h[most]])


def _crossings(place: Array) -> Iterator[Finding]:
    """A deformed outline that crosses itself: the part has no contact with itself."""
    at = crossing(place)
    if at is not None:
        sentence = f"{crosses(at)}; the results are those of a part that goes through itself"
        yield Finding("crossing", 1.0, sentence)


def _gap(contact: OutlineContact, place: Array) -> Array:
    """Distance of places, shape (..., 2), from the contact's surface where it stands [mm]."""
    x, y = np.moveaxis(place - np.asarray(contact.stands()), -1, 0)
    return np.asarray(contact.surface.gap(x, y), dtype=float)


def _zigzag(name: str, profile: ContactProfile) -> Iterator[Finding]:
    """A pressure that alternates from node to node: the mesh does not resolve the contact, or a step is unstable."""
    peak = float(profile.pressure.max(initial=0.0))
    for amplitude, middle, nodes in (*_on_slopes(profile), *_up_and_down(profile)):
        x, y = profile.place[middle]
        apart = np.linalg.norm(np.diff(profile.reference[nodes], axis=0), axis=1)
        edges = np.minimum(np.append(apart, apart[-1]), np.append(apart[0], apart))
        yield Finding(
            f"zigzag {name}",
            amplitude,
            f"contact '{name}': the pressure alternates from node to node by ±{amplitude:.3g} MPa near "
            f"({x:.4g}, {y:.4g}), with a peak of {peak:.3g} MPa: take smaller elements there",
            np.column_stack([profile.reference[nodes], edges]),
        )


def _on_slopes(profile: ContactProfile) -> Iterator[tuple[float, int, NDArray[np.intp]]]:
    """Amplitude [MPa], middle and nodes of a zone where the pressure alternates about its course, steep or not."""
    for zone in profile.zones():
        bend = np.diff(profile.pressure[zone.nodes], 2)
        turns = bend[1:] * bend[:-1] < 0
        size = np.minimum(np.abs(bend[1:]), np.abs(bend[:-1])) * turns / 4
        for first in range(len(size) - ALTERNATES + 2):
            amplitude = float(size[first : first + ALTERNATES - 1].min())
            if amplitude > ZIGZAG * float(profile.pressure.max()):
                yield amplitude, int(zone.nodes[first + 1]), zone.nodes


def _up_and_down(profile: ContactProfile) -> Iterator[tuple[float, int, NDArray[np.intp]]]:
    """The same of five nodes on which the pressure goes up and down twice, to nothing between or not."""
    k, p = len(profile.t), profile.pressure
    if k < 5 or p.max() <= NO_PRESSURE:
        return
    nodes = np.lib.stride_tricks.sliding_window_view(np.arange(k + 4) % k, 5)  # around a contact that closes, too
    joins = np.zeros(k, dtype=bool)  # whether a mesh edge joins a node to the next one
    joins[profile.edges[(profile.edges[:, 1] - profile.edges[:, 0]) % k == 1, 0]] = True
    joins[profile.edges[(profile.edges[:, 0] - profile.edges[:, 1]) % k == 1, 1]] = True
    steps = np.diff(p[nodes], axis=1) * (1.0, -1.0, 1.0, -1.0)
    size = np.maximum(steps.min(axis=1), -steps.max(axis=1)) / 2
    for first in np.flatnonzero((size > UP_AND_DOWN * p.max()) & joins[nodes[:, :4]].all(axis=1)):
        yield float(size[first]), int(nodes[first, 2]), nodes[first]


def _uneven_stretch(name: str, profile: ContactProfile) -> Iterator[Finding]:
    """A surface that wears, and whose stretch goes up and down from mesh edge to mesh edge: so does the wear."""
    edges = profile.edges[np.argsort(profile.t[profile.edges].min(axis=1))]
    length, deformed = (
        np.linalg.norm(x[edges[:, 1]] - x[edges[:, 0]], axis=1) for x in (profile.reference, profile.place)
    )
    stretch = deformed / length
    joins = edges[:-1].max(axis=1) == edges[1:].min(axis=1)
    rise = np.diff(stretch)
    size = np.minimum(np.abs(rise[:-1]), np.abs(rise[1:])) / 2
    loaded = profile.pressure[edges[1:-1]].max(axis=1) > HALF * profile.pressure.max(initial=0.0)
    size = np.where((rise[:-1] * rise[1:] < 0) & joins[:-1] & joins[1:] & loaded, size, 0.0)
    for middle in np.flatnonzero(size > UP_AND_DOWN) + 1:
        x, y = profile.place[edges[middle]].mean(axis=0)
        around, amplitude = slice(middle - 1, middle + 2), float(size[middle - 1])
        yield Finding(
            f"stretch {name}",
            amplitude,
            f"contact '{name}': the stretch of the surface goes up and down by ±{amplitude:.2g} from one mesh edge to "
            f"the next near ({x:.4g}, {y:.4g}), and the wear with it: take smaller elements there",
            np.column_stack([profile.reference[edges[around]].mean(axis=1), length[around]]),
        )


def _imbalance(stage: Stage, forces: Mapping[str, Array]) -> Iterator[Finding]:
    total, largest = sum(forces.values()), max((float(np.abs(f).max()) for f in forces.values()), default=0.0)
    for axis, name in enumerate("xy"):
        held = any(getattr(support, name) for support in stage.scene.supports)
        off = abs(float(np.atleast_1d(total)[axis])) if forces else 0.0
        if not held and off > UNBALANCED * largest:
            yield Finding(
                f"balance {name}",
                off / largest,
                f"the forces along {name} do not balance: their sum is {off / largest:.1e} of the largest",
            )


def _crushed(stage: Stage) -> Iterator[Finding]:
    points = stage.problem.points
    jacobian = stage.problem.jacobians()
    worst = int(jacobian.argmin())
    least, (x, y) = float(jacobian[worst]), points.centres[worst]
    if least < CRUSHED:
        crushed = jacobian < CRUSHED
        yield Finding(
            "crushed",
            1 - least,
            f"an element at ({x:.4g}, {y:.4g}) is squeezed to {least:.2g} of its volume: the mesh does not resolve the "
            "section there; take smaller elements",
            np.column_stack([points.centres[crushed], points.edges[crushed]]),
        )


def _useless_inlets(stage: Stage, stroke: Stroke) -> Iterator[Finding]:
    """A fluid that comes in nowhere, or on both sides of a contact that slides."""
    sliding = {spec.name for spec in stage.scene.contacts if spec.slides}
    for name, fluid in stage.fluids.items():
        pressure = fluid.pressure.Get()
        if pressure > 0 and not fluid.shares.any():
            sentence = f"surfaces touch the whole inlet of '{name}', so that its {pressure:.3g} MPa act nowhere; name "
            sentence = f"stroke '{stroke.name}': {sentence}edges on the sealed side in fluid.inlet"
            yield Finding(f"inlet {stroke.name} {name}", pressure, sentence)
        for contact in fluid.on_both_sides() if pressure > 0 else ():
            if contact.name in sliding:
                what = (
                    f"stroke '{stroke.name}': contact '{contact.name}' lies on the inlet of '{name}' and seals nothing"
                )
                sentence = (
                    f"{what}: the {pressure:.3g} MPa act on both sides; name edges on the sealed side in fluid.inlet"
                )
                yield Finding(f"inlet {stroke.name} {name} {contact.name}", pressure, sentence)


def _lower_friction(stage: Stage, stroke: Stroke) -> Iterator[Finding]:
    """Friction that the part does not bear, so that only a share of it acts in this solve."""
    share, why = stage.friction_shares.get(stroke.name, (1.0, ""))
    if share < 1:
        sentence = f"stroke '{stroke.name}': friction {why}; the results are for {100 * share:.0f} % of the friction, "
        sentence += f"with which it still slides; their errors say what the rest of it may change. {CONSEQUENCES[why]}"
        yield Finding(f"less friction {stroke.name}", 1 - share, sentence)


def _blow_by(stage: Stage, stroke: Stroke) -> Iterator[Finding]:
    """A contact that carries less than the fluid's pressure: the fluid would open it."""
    for blown in stage.blow_by():
        what = f"stroke '{stroke.name}': the {blown.pressure:.3g} MPa of '{blown.inlet}'"
        if blown.holds > 0:
            sentence = f"would open the contact at '{blown.edge}', which carries {blown.holds:.3g} MPa at most"
            sentence += "; the results are for a seal that does not open, and so are their stated errors"
        elif blown.meets:
            sentence = f"meets the fluid of inlet '{blown.meets}', which has less; no contact is between them"
        else:
            sentence = f"reaches '{blown.edge}', the last of the fluid's edges that way, and no contact stops it; if "
            sentence += "one stops it beyond, name the edges up to there in fluid.edges"
        yield Finding(f"blow-by {stroke.name} {blown.inlet}", blown.pressure - blown.holds, f"{what} {sentence}")


def _barely_held(stage: Stage, stroke: Stroke) -> Iterator[Finding]:
    """A fluid that a contact holds by less than its pressure errs by: on other elements it may come in further."""
    for held in stage.barely_held():
        sentence = (
            f"stroke '{stroke.name}': the contact at '{held.edge}' carries {held.ridge:.3g} MPa where it holds the "
            f"{held.pressure:.3g} MPa of '{held.inlet}', and only {held.behind:.3g} MPa behind: the fluid may come in "
            f"up to '{held.next_edge}', and pressures and wear would be others; if it is held so at the end, too, the "
            "stated errors have a part by it; compare with a finer accuracy"
        )
        over = held.ridge / held.pressure - 1
        yield Finding(f"{BARELY_HELD} {stroke.name} {held.inlet} {held.edge}", 1 - over, sentence)
