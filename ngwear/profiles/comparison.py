"""A measured profile against a run: worn areas, deviations, and the specific wear rate that fits it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import trapezoid

from ngwear.errors import ResultError, SceneError
from ngwear.profiles.alignment import OUTLIER, STEEPEST, Alignment, align
from ngwear.profiles.measured import WRONG_UNIT, Profile, guess_unit, read_profile
from ngwear.profiles.worn_edge import WornEdge, read_worn_edge

Array = NDArray[np.float64]
COMPARISON = "measured.json"
# Between a symmetric profile, which fits as well either way, and a wrong one, which fits many times better once turned.
FAR_BETTER = 0.6  # a misfit below this share of another's
BEYOND = 1.05  # of the run's distance: further, the fit rests on no computed outline; 5 % are extrapolated in silence
POOR = 0.5  # a misfit, over the heights' spread, beyond which profile and outline hardly resemble each other
# A note, no more: a levelled profile that begins where it should lies within them.
LARGE_TILT, LARGE_SHIFT = np.radians(3.0), 0.1  # the shift as a share of the profile's length


@dataclass(frozen=True)
class Comparison:
    """A profile aligned with a run's worn edge.

    Attributes
    ----------
    edge : WornEdge
    alignment : Alignment
    distance : float
        Sliding distance of the measured part [mm].
    notes : tuple of str
        Warnings in sentences.
    """

    edge: WornEdge
    alignment: Alignment
    distance: float
    notes: tuple[str, ...]

    @property
    def compared(self) -> float:
        """Sliding distance of the outline that is compared: the part's, or the run's end if that comes first [mm]."""
        return min(self.distance, self.edge.end)

    @property
    def factor(self) -> float | None:
        """Measured over simulated specific wear rate [-]; None if it lies beyond the run's end."""
        return None if self.beyond else self.alignment.distance / self.distance

    @property
    def beyond(self) -> bool:
        """Whether the profile is worn deeper than anything that the run has computed."""
        return self.alignment.distance > BEYOND * self.edge.end

    def depth(self, distance: float) -> Array:
        """Worn depth of the run's outline at the profile's points after a sliding distance [mm]."""
        worn = self.edge.heights[0] - self.edge.at(distance)
        return np.interp(self.alignment.place, self.edge.place, worn)

    @property
    def measured_depth(self) -> Array:
        """Depth of the profile's points below the unworn outline [mm]."""
        return np.interp(self.alignment.place, self.edge.place, self.edge.heights[0]) - self.alignment.height

    def area(self, depth: Array) -> float:
        """``int depth dx`` over the profile's points by trapezoids, signed; every point counts, dust too [mm²]."""
        return float(trapezoid(depth, self.alignment.place))

    def as_dict(self) -> dict[str, Any]:
        """All numbers, as in ``measured.json``; a best fit beyond the run's end gives no rate."""
        edge, found = self.edge, self.alignment
        place, motion = found.place, found.placement
        out: dict[str, Any] = {
            "scene": edge.scene,
            "points compared [-]": len(place),
            f"compared from {edge.axis} [mm]": float(place[0]),
            f"compared to {edge.axis} [mm]": float(place[-1]),
            f"shift along {edge.axis} [mm]": motion.along,
            "shift of height [mm]": motion.up,
            "tilt [deg]": float(np.degrees(motion.tilt)),
            "sliding distance of the part [mm]": self.distance,
            "strokes of the part [-]": edge.strokes_at(self.distance),
            "sliding distance compared [mm]": self.compared,
            "worn area, measured [mm^2]": self.area(self.measured_depth),
        }
        for name, distance in (("", self.compared), ("best fit: ", found.distance)):
            deviation = self.depth(distance) - self.measured_depth
            worst = int(np.argmax(np.abs(deviation)))
            out |= {
                f"{name}worn area, simulated [mm^2]": self.area(self.depth(distance)),
                f"{name}RMS deviation [mm]": float(np.sqrt(np.mean(deviation**2))),
                f"{name}largest deviation, measured less simulated [mm]": float(deviation[worst]),
                f"{name}largest deviation at {edge.axis} [mm]": float(place[worst]),
            }
        out["best fit: sliding distance of the run [mm]"] = found.distance
        out["best fit: strokes of the run [-]"] = edge.strokes_at(found.distance)
        error = found.error / self.distance
        known = np.isfinite(error) and not self.beyond
        out["measured over simulated specific wear rate [-]"] = self.factor
        out["standard error of it [-]"] = error if known else None
        for contact, rate in edge.wear_rates.items():
            out[f"{contact} specific wear rate [mm^2/N]"] = None if self.factor is None else self.factor * rate
            out[f"{contact} standard error of specific wear rate [mm^2/N]"] = error * rate if known else None
        out["notes"] = list(self.notes)
        return out

    def write(self, folder: Path | str) -> Path:
        """Write ``measured.json`` into a folder; return its path.

        Raises
        ------
        ResultError
            If it cannot be written.
        """
        path = Path(folder) / COMPARISON
        try:
            path.write_text(json.dumps(self.as_dict(), indent=2) + "\n", encoding="utf-8")
        except OSError as error:
            raise ResultError(f"{path} cannot be written: {error.strerror}") from error
        return path


def compare_profile(
    folder: Path | str,
    path: Path | str,
    *,
    edges: Sequence[str] = (),
    strokes: float | None = None,
    distance: float | None = None,
    upside_down: bool = False,
    mirrored: bool = False,
) -> Comparison:
    """Read a profile, align it with a run's worn edge and fit the specific wear rate.

    Under Archard's law with a constant k an outline depends on k and the sliding distance d through their product
    alone: both enter the problem as ``k p dd`` and nowhere else, so a run with f times the rate passes through the same
    outlines f times sooner. The distance d* of the run whose outline meets the profile best hence gives
    ``k = k_run d* / d_part``, without another run; with several contacts all rates are scaled alike.

    It does not hold when something besides k p dd depends on the distance or on time: friction or a rate that changes
    with the distance, or rubber with memory before it has settled (a note says so). The standard error is the profile's
    alone; the error of the run (``summary.json``) must be added. If the profile contains no unworn part, wear and a
    shift of height cannot be distinguished, and the standard error is large.

    Parameters
    ----------
    folder : Path or str
        Of a run that has ended.
    path : Path or str
        The profile, as in ``read_profile``.
    edges : sequence of str
        As in ``read_worn_edge``.
    strokes, distance : float or None
        Sliding of the measured part: strokes, or distance [mm]; by default the run's.
    upside_down, mirrored : bool
        Reverse the profile's heights or its direction first.

    Raises
    ------
    SceneError
        If the profile is in another unit, upside down or mirrored, and as in ``read_profile`` and ``read_worn_edge``.
    ResultError
        If the run cannot be read.
    """
    edge = read_worn_edge(folder, edges=edges)
    measured = read_profile(path, length=edge.length)
    if strokes is not None and distance is not None:
        raise SceneError("distance", distance, "give strokes or a distance, not both")
    slid = edge.distance_at(strokes) if strokes is not None else edge.end if distance is None else distance
    if not (np.isfinite(slid) and slid > 0):
        raise SceneError("distance", slid, "the part must have slid some way")
    profile = measured.turned(upside_down=upside_down, mirrored=mirrored)
    found = align(profile, edge)
    _require_orientation(profile, edge, found, str(path), flags=(upside_down, mirrored))
    return Comparison(edge, found, slid, (*measured.notes, *_notes(profile, edge, found, slid)))


def _require_orientation(
    profile: Profile, edge: WornEdge, found: Alignment, path: str, flags: tuple[bool, bool]
) -> None:
    """Raise if the profile upside down, mirrored, or in another unit fits far better."""
    heights = max(float(np.ptp(h - np.polynomial.Polynomial.fit(edge.place, h, 1)(edge.place))) for h in edge.heights)
    line = np.polynomial.Polynomial.fit(profile.x, profile.z, 1)
    ratio = float(np.ptp(profile.z - line(profile.x))) / heights
    unit = 1e-3 if ratio > WRONG_UNIT else 1e3 if ratio < 1 / WRONG_UNIT else 1.0
    tried = []
    for scale in {1.0, unit}:
        for turns in ((False, False), (True, False), (False, True), (True, True)):
            if (scale, turns) == (1.0, (False, False)):
                continue
            turned = Profile(profile.x, scale * profile.z).turned(upside_down=turns[0], mirrored=turns[1])
            tried.append((align(turned, edge).misfit, scale, turns))
    misfit, scale, turns = min(tried)
    if misfit > FAR_BETTER * found.misfit:
        return
    if scale != 1:
        change = "divided" if scale < 1 else "multiplied"
        remedy = (
            f"the heights span so much about their line, the run's {heights:.4g} mm, and {change} by 1000 they fit: "
        )
        remedy += guess_unit(ratio) + ("; or, if mm is right, the run is far too short" if scale < 1 else "")
        raise SceneError(f"{path}, z", ratio * heights, remedy)
    names = [name for name, turn in zip(("upside down", "mirrored"), turns, strict=True) if turn]
    options = [
        f"{'leave out' if flag else 'give'} {option}"
        for option, flag, turn in zip(
            ("--upside-down (upside_down=True)", "--mirrored (mirrored=True)"), flags, turns, strict=True
        )
        if turn
    ]
    raise SceneError(
        path,
        " and ".join(names),
        f"so turned it fits far better (misfit {misfit:.0%} of its heights' spread instead of {found.misfit:.0%}): "
        f"heights are positive out of the material, and the line runs as the scene's axis; {' and '.join(options)}",
    )


def _notes(profile: Profile, edge: WornEdge, found: Alignment, slid: float) -> list[str]:
    notes, motion = [], found.placement
    if abs(motion.tilt) > 0.999 * STEEPEST:
        notes.append("the tilt is at its bound of 15 degrees: level the profile, or name the edge that was measured")
    elif abs(motion.tilt) > LARGE_TILT:
        notes.append(f"the profile was tilted by {np.degrees(motion.tilt):.2g} degrees: is it levelled?")
    if abs(motion.along) > LARGE_SHIFT * profile.length:
        notes.append(f"the profile was shifted by {motion.along:.4g} mm along the edge: does it lie where it should?")
    if len(found.place) < 0.9 * len(profile.x):
        notes.append(f"{len(profile.x) - len(found.place)} of {len(profile.x)} points lie beyond the edge")
    if found.misfit > POOR:
        notes.append(
            f"the misfit is {found.misfit:.0%} of the heights' spread: profile and outline hardly resemble each other, "
            "or there is more noise than wear"
        )
    if found.outliers:
        notes.append(
            f"{found.outliers} points stand out from the best fit by more than {OUTLIER:.0f} times the noise: dust? "
            "They weigh little in the fit, but count in the measured area and in the deviations"
        )
    if slid > edge.end:
        notes.append(f"the part has slid {slid:.6g} mm, the run {edge.end:.6g}: compared with the run's end")
    if found.distance > BEYOND * edge.end:
        strokes = edge.strokes_at(found.distance)
        notes.append(
            f"the profile is worn deeper than the run's last outline: run about {np.ceil(1.2 * strokes):.0f} strokes, "
            f"or with a specific wear rate {1.2 * found.distance / edge.end:.2g} times as large, and compare again"
        )
    if edge.has_memory:
        notes.append("the rubber is viscoelastic: its outlines depend on time too, and the wear rate is approximate")
    if edge.laws_vary:
        notes.append("friction or wear follow the sliding distance: the wear rate, a mean over the run, is approximate")
    return notes
