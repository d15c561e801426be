"""Align a measured profile with a worn edge: shift, tilt and sliding distance by one robust least-squares fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.signal import correlate

from ngwear.errors import SceneError
from ngwear.profiles.measured import FEWEST, Profile
from ngwear.profiles.worn_edge import FAR, WornEdge

Array = NDArray[np.float64]
STEEPEST = np.radians(15.0)  # tilt that is sought: far more than a levelled profile has
OVERLAP = 0.6  # of the shorter of profile and edge: less in common fits by chance
# Shifts, shares of the run's distance and points of a first search on a grid, which only has to find the right hollow.
SHIFTS, TRIED, THINNED = 400, (0.0, 0.05, 0.15, 0.4, 0.7, 1.0, 2.0), 400
NEAR = 0.1  # of the edge's length: how far the shift may move from the best one tried; tens of steps
AS_GOOD = 1.2  # times the least mean square: among such shifts the smallest is taken; a flat slides along itself
ROUNDS = 4  # which points lie on the edge, and how large the noise is, are found again in each
NO_NOISE = 1e-7  # mm: an atom, and no profilometer's noise; profiles that were computed have none
OUTLIER = 8.0  # times the noise: of a million points, none by chance, nor by waviness that is no dust


@dataclass(frozen=True)
class Placement:
    """A rigid motion in the plane: rotation about a point of the profile, then a shift.

    Attributes
    ----------
    along, up : float
        Shift [mm].
    tilt : float
        Rotation, counter-clockwise in the view of x to the right and heights upwards [rad].
    centre : tuple of float
        Of the rotation, in the profile's own coordinates [mm].
    """

    along: float
    up: float
    tilt: float
    centre: tuple[float, float]

    def __call__(self, x: Array, z: Array) -> tuple[Array, Array]:
        """Places and heights over the edge [mm]."""
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        x, z = x - self.centre[0], z - self.centre[1]
        return self.centre[0] + self.along + c * x - s * z, self.centre[1] + self.up + s * x + c * z


@dataclass(frozen=True)
class Alignment:
    """A profile aligned with an edge.

    Attributes
    ----------
    placement : Placement
    place, height : array, shape (k,)
        The profile's points that lie over the edge, places rising [mm].
    distance : float
        Sliding distance of the run whose outline fits the profile best [mm]; beyond the run's end an extrapolation.
    error : float
        Standard error of the distance [mm].
    misfit : float
        Root mean square of the residuals, over that of the profile about its own straight line [-].
    outliers : int
        Points whose distance from the outline is more than eight times the noise.
    """

    placement: Placement
    place: Array
    height: Array
    distance: float
    error: float
    misfit: float
    outliers: int


def align(profile: Profile, edge: WornEdge) -> Alignment:
    """Fit shift, tilt and sliding distance together, each deviation weighted less the more it exceeds the noise.

    A separate fit would take wear for tilt. The residual is the vertical distance of each placed point
    from the outline at the sliding distance d,

        r_i = z_i' - h(x_i', d),   (x', z') = R(tilt) (x, z) + shift,

    under the loss ``2 (sqrt(1 + r²/n²) - 1)`` with n the residuals' median deviation, so that dust and places with
    another wear than in the run have little influence. All shifts that leave 60 % of the profile over the edge are
    tried first. The tilt is at most 15 degrees.

    The error of d comes from the curvature of the squares at the best fit, with the residuals' variance times their
    correlation length in points: a profile sampled twice as densely contains little more information.

    Raises
    ------
    SceneError
        If the profile does not overlap the edge at any shift.
    """
    p, span = _coarse(profile, edge)
    centre = (float(profile.x.mean()), float(profile.z.mean()))

    def placed(p: Array) -> tuple[Array, Array]:
        return Placement(p[0], p[1], p[2], centre)(profile.x, profile.z)

    def residuals(p: Array, on: NDArray[np.bool_]) -> Array:
        place, height = placed(p)
        return height[on] - np.interp(place[on], edge.place, edge.at(p[3] * edge.end))

    near = NEAR * edge.length
    low = [max(span[0], p[0] - near), -np.inf, -STEEPEST, 0.0]
    high = [min(span[1], p[0] + near), np.inf, STEEPEST, FAR]
    scale = [0.01 * profile.length, max(float(np.ptp(profile.z)), 1e-6), 0.01, 0.1]
    on = np.ones(len(profile.x), dtype=bool)
    for _ in range(ROUNDS):
        place, _height = placed(p)
        over = (place >= edge.place[0]) & (place <= edge.place[-1])
        on = over if over.sum() >= FEWEST else on
        left = residuals(p, on)
        # 1.4826 makes a standard deviation of the median of absolute deviations, for normal noise.
        noise = max(1.4826 * float(np.median(np.abs(left - np.median(left)))), NO_NOISE)
        found = least_squares(
            residuals, p, bounds=(low, high), x_scale=scale, loss="soft_l1", f_scale=noise, args=(on,), max_nfev=200
        )
        p = found.x
    place, height = placed(p)
    left = residuals(p, on)
    line = np.polynomial.Polynomial.fit(place[on], height[on], 1)
    spread = float(np.sqrt(np.mean((height[on] - line(place[on])) ** 2)))
    order = np.argsort(place[on])
    return Alignment(
        placement=Placement(float(p[0]), float(p[1]), float(p[2]), centre),
        place=place[on][order],
        height=height[on][order],
        distance=float(p[3]) * edge.end,
        error=_error(found.jac, left) * edge.end,
        misfit=float(np.sqrt(np.mean(left**2))) / max(spread, NO_NOISE),
        outliers=int((np.abs(left) > OUTLIER * noise).sum()),
    )


def _coarse(profile: Profile, edge: WornEdge) -> tuple[Array, tuple[float, float]]:
    """Shift, height, tilt and share of the run's distance to start from, by linear fits at many shifts; their span."""
    pick = np.unique(np.linspace(0, len(profile.x) - 1, THINNED).round().astype(int))
    x, z = profile.x[pick], profile.z[pick]
    offset = x - profile.x.mean()
    reach = OVERLAP * min(profile.length, edge.length)
    span = float(edge.place[0] - x[-1] + reach), float(edge.place[-1] - x[0] - reach)
    outlines = np.array([edge.at(share * edge.end) for share in TRIED])
    found = []
    for shift in np.linspace(*span, SHIFTS):
        on = (x + shift >= edge.place[0]) & (x + shift <= edge.place[-1])
        if on.sum() < FEWEST:
            continue
        where = np.clip(np.searchsorted(edge.place, x[on] + shift), 0, len(edge.place) - 1)
        goal = (outlines[:, where] - z[on]).T
        matrix = np.column_stack([np.ones(on.sum()), offset[on]])
        solved, *_ = np.linalg.lstsq(matrix, goal, rcond=None)
        steep = np.abs(solved[1]) > np.tan(STEEPEST)
        solved[:, steep] = [goal.mean(axis=0)[steep], np.zeros(steep.sum())]
        squares = ((goal - matrix @ solved) ** 2).mean(axis=0)
        best = int(np.argmin(squares))
        found.append((squares[best], shift, solved[0, best], solved[1, best], TRIED[best]))
    if not found:
        raise SceneError(
            "profile", f"{profile.length:.4g} mm long", f"nowhere lies over the edge, {edge.length:.4g} mm long"
        )
    table = np.array(found)
    good = table[table[:, 0] <= AS_GOOD * table[:, 0].min()]
    _, shift, up, slope, share = good[np.argmin(np.abs(good[:, 1]))]
    return np.array([shift, up, np.arctan(slope), share]), span


def _error(jacobian: Array, left: Array) -> float:
    """Standard error of the last parameter, infinite if the data do not determine it."""
    curvature = jacobian.T @ jacobian
    size = np.sqrt(np.diag(curvature))
    if not size.all() or np.linalg.cond(curvature / np.outer(size, size)) > 1e12:
        return float("inf")
    noise = left - left.mean()
    correlation = correlate(noise, noise, method="fft")[len(left) - 1 :]
    correlation = correlation / max(correlation[0], 1e-300)
    until = int(np.argmax(correlation <= 0)) or len(correlation)
    points = 2 * float(correlation[:until].sum()) - 1
    variance = float(np.mean(left**2)) * len(left) / max(len(left) - 4, 1) * points
    return float(np.sqrt(variance * np.linalg.inv(curvature)[-1, -1]))
