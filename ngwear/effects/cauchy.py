"""Cauchy stress and principal stretch of a section's material points."""

from __future__ import annotations

import numpy as np

from ngwear.effects.base import Array
from ngwear.effects.invariants import Section


def cauchy_stress(strain: Array, stress: Array) -> Array:
    """``sigma = P F^T / J`` of a stress P conjugate to the strain (see ``fields.material_points``) [MPa].

    Components xx, yy, xy and zz, shape (..., 4); zz is the hoop stress, or that across the plane in plane strain.
    """
    at = Section(np.array(np.moveaxis(strain, -1, 0), order="C"))
    xx, xy, yx, yy = at.gradient
    p = np.moveaxis(stress, -1, 0)
    both = 0.5 * (p[0] * yx + p[1] * yy + p[2] * xx + p[3] * xy)
    parts = (p[0] * xx + p[1] * xy, p[2] * yx + p[3] * yy, both, p[4] * at.hoop)
    return np.stack([part / at.j for part in parts], axis=-1)


def largest_stretch(strain: Array) -> Array:
    """The largest principal stretch [-], shape (...): of both in the plane and the one across it."""
    at = Section(np.array(np.moveaxis(strain, -1, 0), order="C"))
    xx, yy, twice, across = np.moveaxis(at.stretching, -1, 0)
    in_plane = 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), 0.5 * twice)
    return np.sqrt(np.maximum(in_plane, across))
