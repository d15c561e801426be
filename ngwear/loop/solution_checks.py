"""Look at an accepted solve: overlap, a pressure that alternates, forces out of balance, crushed elements, blow-by.

Every stroke that is recorded is looked at. A finding is a sentence with the place and the value; the run keeps the
worst of each kind and place, and lists them as warnings.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.contact_profile import ContactProfile
from ngwear.loop.stage import Stage
from ngwear.scene.program import Stroke

Array = NDArray[np.float64]

DEEP = 0.01  # of the mesh edge there: overlap with a surface
UNLISTED = ", whose edges do not name it: name it there, or give no edges, so that any may touch"
COARSE = ": the mesh there is too coarse for the contact; take smaller elements"
ZIGZAG = 0.1  # of the contact's peak: amplitude of a pressure that alternates from node to node
ALTERNATES = 4  # nodes in a row whose second difference changes sign: a smooth pressure does so once or twice
UNBALANCED = 1e-5  # of the largest force: sum of all forces where no support takes a part of it
CRUSHED = 0.5  # J of an element; rubber bears far less compression


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
    """

    key: str
    amount: float
    sentence: str


def findings(
    stage: Stage, profiles: Mapping[str, ContactProfile], forces: Mapping[str, Array], stroke: Stroke
) -> tuple[Finding, ...]:
    """Findings of the present equilibrium; ``profiles`` and ``forces`` are those of the stroke's report."""
    found = [*_overlaps(stage), *_imbalance(stage, forces), *_crushed(stage), *_blow_by(stage, stroke)]
    for name, profile in profiles.items():
        found += _zigzag(name, profile)
    return tuple(found)


def _overlaps(stage: Stage) -> Iterator[Finding]:
    """Nodes of the whole outline that lie inside a surface, whether its contact lists their edges or not."""
    body, line = stage.body, stage.body.outline
    parts = stage.problem.fields[DISPLACEMENT].components
    moved = np.column_stack([part.vec.FV().NumPy()[line.vertices[:, 0]] for part in parts])
    place = body.contour.at(line.t[:, 0]) + moved
    length = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1)
    for name, contact in stage.contacts.items():
        listed = np.isin(line.names, contact.edges)
        listed |= np.roll(listed, 1)  # the node between two edges
        gap = _gap(contact, place)
        # In a contact that wears, a solve ends with the depth that it wears inside the surface.
        resting = listed if not contact.wears else np.zeros_like(listed)
        for among, advice in ((~listed, UNLISTED), (resting, COARSE)):
            depth = np.where(among, -gap - DEEP * length, 0.0)
            worst = int(np.argmax(depth))
            if depth[worst] > 0:
                edge, (x, y), deep = line.names[worst], place[worst], -float(gap[worst])
                where = f"edge '{edge}' lies {deep:.3g} mm inside the surface of contact '{name}' at ({x:.4g}, {y:.4g})"
                yield Finding(f"overlap {name} {edge}", deep, f"{where}{advice}")


def _gap(contact: OutlineContact, place: Array) -> Array:
    """Distance of places from the contact's surface where it stands [mm]."""
    x, y = place.T - np.asarray(contact.stands())[:, None]
    return np.asarray(contact.surface.gap(x, y), dtype=float)


def _zigzag(name: str, profile: ContactProfile) -> Iterator[Finding]:
    """A pressure that alternates from node to node: the mesh does not resolve the contact, or a step is unstable."""
    peak = float(profile.pressure.max(initial=0.0))
    for zone in profile.zones():
        bend = np.diff(profile.pressure[zone.nodes], 2)
        turns = bend[1:] * bend[:-1] < 0
        size = np.minimum(np.abs(bend[1:]), np.abs(bend[:-1])) * turns / 4
        for first in range(len(size) - ALTERNATES + 2):
            amplitude = float(size[first : first + ALTERNATES - 1].min())
            if amplitude > ZIGZAG * peak:
                x, y = profile.place[zone.nodes][first + 1]
                yield Finding(
                    f"zigzag {name}",
                    amplitude,
                    f"contact '{name}': the pressure alternates from node to node by ±{amplitude:.3g} MPa near "
                    f"({x:.4g}, {y:.4g}), with a peak of {peak:.3g} MPa: take smaller elements there",
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
    least, (x, y) = stage.problem.least_jacobian()
    if least < CRUSHED:
        yield Finding(
            "crushed",
            1 - least,
            f"an element at ({x:.4g}, {y:.4g}) is squeezed to {least:.2g} of its volume: the mesh does not resolve the "
            "section there; take smaller elements",
        )


def _blow_by(stage: Stage, stroke: Stroke) -> Iterator[Finding]:
    """A contact that carries less than the fluid's pressure: the fluid would open it."""
    for fluid in stage.fluids.values():
        if (blown := fluid.blow_by()) is None:
            continue
        what = f"stroke '{stroke.name}': the {blown.pressure:.3g} MPa of '{blown.inlet}'"
        sentence = (
            f"{what} would open the contact at '{blown.edge}', which carries {blown.holds:.3g} MPa at most; the "
            "results are for a seal that does not open"
            if blown.holds > 0
            else f"{what} reaches '{blown.edge}', the last of the fluid's edges that way, and no contact stops it; if "
            "one stops it beyond, name the edges up to there in fluid.edges"
        )
        yield Finding(f"blow-by {stroke.name} {blown.inlet}", blown.pressure - blown.holds, sentence)
