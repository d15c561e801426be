"""Cauchy stress of the present state as an NGSolve CoefficientFunction."""

from __future__ import annotations

from typing import Any

import ngsolve as ng

from ngwear.effects.base import DISPLACEMENT, VOLUMETRIC_STRESS
from ngwear.loop.stage import Stage


def cauchy_stress(stage: Stage) -> Any:
    """Cauchy stress of the hyperelastic part, a 3 x 3 coefficient function [MPa] on the undeformed mesh.

    ``sigma = 2/J dev((psi_1 + I1 psi_2) b - psi_2 b^2) + (Ks (J - 1) + p) I`` with ``b = J^(-2/3) F F^T``, its
    invariants I_i, the derivatives psi_i of the isochoric energy by them, and the unknown p of ``effects.elasticity``.
    The third row and column are the hoop direction of a ring, or normal to a plane section.

    Parameters
    ----------
    stage : Stage
        The function uses the present state of the stage: after another solve it gives the new stress.
    """
    problem, elasticity = stage.problem, stage.elasticity
    u, p = problem.fields[DISPLACEMENT], problem.fields[VOLUMETRIC_STRESS]
    grad = ng.Grad(u)
    hoop = problem.kinematics.hoop_stretch(u)
    f = ng.CF((1 + grad[0, 0], grad[0, 1], 0, grad[1, 0], 1 + grad[1, 1], 0, 0, 0, hoop), dims=(3, 3))
    j = ng.Det(f)
    b = j ** (-2 / 3) * f * f.trans
    i1 = ng.Trace(b)
    i2 = 0.5 * (i1 * i1 - ng.Trace(b * b))
    by_1, by_2, *_ = elasticity.material.isochoric_slopes(i1, i2)
    isochoric = (2 / j) * ((by_1 + i1 * by_2) * b - by_2 * (b * b))
    pointwise, _ = elasticity.split
    mean = pointwise * (j - 1) + p
    return isochoric + (mean - ng.Trace(isochoric) / 3) * ng.Id(3)
