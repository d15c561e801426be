"""What a hard case has to prove: findings, each a number beside the bound that physics sets for it."""

from dataclasses import dataclass

import numpy as np

from ngwear.effects.contact import OutlineContact
from ngwear.effects.invariants import Invariants
from ngwear.equilibrium.problem import Problem

RESIDUAL = 1e-6  # nodal forces out of balance over all nodal forces
VOLUME_RATIO = 0.5  # the least J of a rubber that may be pressed, not crushed
SUCTION = 1e-9  # of the peak: what a contact that only presses may pull at a mesh edge
ROUGHNESS = 0.02  # of the peak: a pressure's ripple from node to node
BOOK = 1e-6  # worn area taken off the outline against the law's


@dataclass(frozen=True)
class Finding:
    """A measured number and the bound that it has to keep, from above or (``least``) from below."""

    what: str
    value: float
    bound: float
    least: bool = False

    @property
    def holds(self) -> bool:
        """Whether the bound is kept; never for a value that is not a number."""
        return bool(self.value >= self.bound if self.least else self.value <= self.bound)

    def __str__(self) -> str:
        return f"{self.what} {self.value:.2g} ({'>=' if self.least else '<='} {self.bound:.2g})"


def near(what: str, value: float, reference: float, tolerance: float) -> Finding:
    """The relative distance of a value from its reference."""
    return Finding(f"error of the {what}", abs(value - reference) / abs(reference), tolerance)


def body(problem: Problem) -> list[Finding]:
    """Equilibrium and the least volume ratio of a problem's present state."""
    points = problem.points
    vector = problem.state.vec
    strain = points.strain(vector.FV().NumPy())
    stress, _ = problem._response(tangent=False)
    inner = np.bincount(points.unknowns.ravel(), points.forces(stress).ravel(), minlength=len(vector))
    out = vector.CreateVector()
    problem.residual(out)
    where = problem.part("displacement")
    rest = np.linalg.norm(out.FV().NumPy()[where]) / np.linalg.norm(inner[where])
    return [
        Finding("residual", float(rest), RESIDUAL),
        Finding("min J", float(Invariants.of(strain).j.min()), VOLUME_RATIO, least=True),
    ]


def pressure(contact: OutlineContact) -> list[Finding]:
    """No suction, no ripple."""
    ends = contact.end_pressures()
    profile = contact.profile()
    suction = max(0.0, -ends.mean(axis=1).min()) / ends.max()
    findings = [Finding("suction", suction, SUCTION)]
    ripples = [roughness(zone_length(profile, z), profile.pressure[z.nodes]) for z in profile.zones()]
    ripples = [r * z.peak / profile.pressure.max() for r, z in zip(ripples, profile.zones(), strict=True) if r >= 0]
    if ripples:
        findings.append(Finding("roughness", max(ripples), ROUGHNESS))
    return findings


def zone_length(profile, zone) -> np.ndarray:
    """Way along the deformed outline at the nodes of a zone [mm]."""
    steps = np.linalg.norm(np.diff(profile.place[zone.nodes], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def roughness(s: np.ndarray, p: np.ndarray) -> float:
    """Largest ripple of a pressure over its peak, -1 with less than nine nodes.

    Each node is compared with the cubic through the two neighbours on either side: a checkerboard of amplitude A gives
    A, a smooth profile a fourth difference. The outer tenth of the zone, two nodes at least, where a pressure ends
    in a root or in a corner's singularity, takes no part.
    """
    if len(p) < 9:
        return -1.0
    length, worst = s[-1] - s[0], 0.0
    for i in range(2, len(p) - 2):
        if min(s[i] - s[0], s[-1] - s[i]) < 0.1 * length or not 4 <= i < len(p) - 4:
            continue
        others = [i - 2, i - 1, i + 1, i + 2]
        weights = [np.prod([(s[i] - s[k]) / (s[j] - s[k]) for k in others if k != j]) for j in others]
        signs = np.array([1.0, -1.0, -1.0, 1.0])
        off = p[i] - float(np.dot(weights, p[others]))
        worst = max(worst, abs(off / (1 - float(np.dot(weights, signs)))))
    return worst / float(p.max())


def book(ledger, before, after) -> list[Finding]:
    """Area lost by the outline against the law's."""
    lost = before.area - after.area
    return [
        Finding("area against the law", abs(ledger.removed - ledger.worn) / ledger.worn, BOOK),
        Finding("area off the outline against the book", abs(lost - ledger.removed) / ledger.removed, BOOK),
    ]
