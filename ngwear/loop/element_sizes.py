"""Element edges from the size of the section and the contact widths, for scenes that give ``accuracy.across``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ngwear.loop.stage import Stage
from ngwear.scene.holding import free_directions
from ngwear.scene.scene import Scene

Array = NDArray[np.float64]

# Settled on the shaft, whose depth erred by 2 % with 0.4 and 6 across, and the rod seal (adaptive_against_fixed.py).
COARSE = 0.3  # of the section's smaller extent: where neither contact nor stress asks for less
MOUNTING = 0.04  # of that extent
ROUGH = 0.1  # the same of a part with room to move: settled on the O-ring's time (with 0.04 twice as long)


def with_mounting_lengths(scene: Scene) -> Scene:
    """The scene with element edges for mounting, from the size of the section; unchanged if it gives its own."""
    accuracy = scene.accuracy
    if accuracy.patch is not None:
        return scene
    size = _size(scene)
    edge, coarse = MOUNTING * size, COARSE * size
    lengths = replace(accuracy, across=None, error=None, peak_error=None, patch=edge, mounting=edge, coarse=coarse)
    return replace(scene, accuracy=lengths)


def _size(scene: Scene) -> float:
    return float(np.ptp(scene.part.outline.points, axis=0).min())


def coarse_for_mounting(scene: Scene) -> Scene:
    """The scene with the elements on which it is mounted: not below a share of the section if the part can move.

    The first strokes move such a part by many edges of a fine mesh; on a coarse one Newton's method converges, and its
    states are near those on the next finer mesh.
    """
    return with_patch(scene, ROUGH * _size(scene)) if free_directions(scene) else scene


def with_patch(scene: Scene, least: float) -> Scene:
    """The scene with element edges in contact and for mounting of at least ``least`` [mm]."""
    accuracy, lengths = scene.accuracy, scene.accuracy.lengths
    patch, mounting, coarse = (max(length, least) for length in (lengths.patch, lengths.mounting, lengths.coarse))
    return replace(scene, accuracy=replace(accuracy, patch=patch, mounting=mounting, coarse=coarse))


def with_contact_lengths(stage: Stage, phases: list[Array], across: float) -> Scene:
    """The stage's scene with ``patch`` = contact width / ``across``; unchanged if no contact carries load.

    The width is the mean over all zones of refined contacts in all strokes of the cycle, weighted by their load.
    """
    accuracy, vector = stage.scene.accuracy, stage.problem.state.vec.FV().NumPy()
    keep, moment, load = vector.copy(), 0.0, 0.0
    for phase in phases:
        vector[:] = phase
        for spec in stage.scene.followed:
            for borne, width in stage.contacts[spec.name].profile().loads_and_widths():
                moment, load = moment + borne * width, load + borne
    vector[:] = keep
    if load == 0.0:
        return stage.scene
    patch = moment / load / across
    mounting, coarse = max(accuracy.lengths.mounting, patch), max(accuracy.lengths.coarse, patch)
    return replace(stage.scene, accuracy=replace(accuracy, patch=patch, mounting=mounting, coarse=coarse))
