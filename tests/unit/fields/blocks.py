"""Blocks of quadrilaterals, or of quadrilaterals and triangles, meshed by hand."""

from collections.abc import Callable
from itertools import pairwise

import netgen.meshing as ngm
import ngsolve as ng
import numpy as np

from ngwear.geometry.body import _outline
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.geometry.outline import Outline

SIDES = ("bottom", "right", "top", "left")


class Block(MeshedSection):
    """The unit square in n x m cells, mapped to anywhere; the sides are named from the bottom counter-clockwise.

    A cell is a quadrilateral, or two triangles where ``halved(i, j)`` says so; ``without`` leaves elements out by their
    numbers. Vertices are numbered at random and elements begin at any corner: all orientations come up.
    """

    def __init__(
        self,
        n: int,
        m: int,
        *,
        image: Callable[[np.ndarray], np.ndarray] = lambda x: x,
        halved: Callable[[int, int], bool] = lambda i, j: False,
        without: tuple[int, ...] = (),
    ) -> None:
        rng = np.random.default_rng(5)
        square = np.array([(i / n, j / m) for j in range(m + 1) for i in range(n + 1)])
        points = image(square)
        mesh = ngm.Mesh()
        mesh.dim = 2
        number = {int(k): mesh.Add(ngm.MeshPoint(ngm.Pnt(*points[k], 0))) for k in rng.permutation(len(points))}
        mesh.Add(ngm.FaceDescriptor(surfnr=1, domin=1, bc=1))
        mesh.SetMaterial(1, "rubber")
        at = np.arange(len(points)).reshape(m + 1, n + 1)
        cells = []
        for j in range(m):
            for i in range(n):
                corners = [at[j, i], at[j, i + 1], at[j + 1, i + 1], at[j + 1, i]]
                halves = [corners[:3], [corners[k] for k in (0, 2, 3)]]
                cells += halves if halved(i, j) else [corners]
        cells = [[int(k) for k in np.roll(cell, rng.integers(4))] for cell in cells]
        self.cells = [cell for k, cell in enumerate(cells) if k not in without]
        for cell in self.cells:
            mesh.Add(ngm.Element2D(1, [number[v] for v in cell]))
        lines = (at[0], at[:, -1], at[-1, ::-1], at[::-1, 0])
        for side, line in enumerate(lines):
            for a, b in pairwise(line):
                if any({a, b} <= set(cell) for cell in self.cells):
                    mesh.Add(ngm.Element1D([number[int(a)], number[int(b)]], index=side + 1))
            mesh.SetBCName(side, SIDES[side])
        self.mesh = ng.Mesh(mesh)
        around = np.concatenate([line[:-1] for line in lines])
        names = tuple(name for name, line in zip(SIDES, lines, strict=True) for _ in line[:-1])
        self.base = self.contour = Outline(points[around], names, np.ones(len(around), dtype=bool))

    def move_to(self, contour: Outline) -> None:
        raise NotImplementedError

    @property
    def outline(self):
        """As a ``Body`` has it, of a block with all its elements."""
        if not hasattr(self, "_line"):
            self._line = _outline(self.mesh, self.contour)
        return self._line

    @property
    def size(self) -> float:
        return float(np.ptp(self.contour.points, axis=0).max())


def checkered(i: int, j: int) -> bool:
    """Cells to be halved: about a third of them."""
    return (i + 2 * j) % 3 == 0


def wavy(x: np.ndarray) -> np.ndarray:
    """Block 2 mm wide and 1 mm high at a radius from 1 mm on, its inner points displaced from their places."""
    a, b = x.T
    inside = np.sin(np.pi * a) * np.sin(np.pi * b)
    return np.column_stack([2 * a + 0.15 * inside * np.cos(5 * b), 1 + b + 0.12 * inside * np.sin(4 * a + 1)])
