"""Convert a curved mesh of a section to arrays, and back to exactly the same mesh."""

from __future__ import annotations

import netgen.meshing as ngm
import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.errors import MeshError
from ngwear.geometry import section
from ngwear.geometry.outline import Outline

Index = NDArray[np.intp]


def as_arrays(mesh: ng.Mesh) -> dict[str, NDArray[np.float64] | Index]:
    """Arrays that ``from_arrays`` needs besides the outline and its nodes.

    Returns
    -------
    dict
        ``points``, shape (nv, 2) [mm]; ``triangles``, shape (ne, 3); ``segments`` of the outline, shape (m, 2), and
        ``pieces``, shape (m,), of which piece of it from node to node each is a part, 0 for the one from the first.
    """
    points, triangles = section.mesh_arrays(mesh)
    segments = mesh.ngmesh.Elements1D().NumPy()
    ends = segments["nodes"][:, :2].astype(np.intp) - 1
    return {"points": points, "triangles": triangles, "segments": ends, "pieces": segments["index"].astype(np.intp) - 1}


def from_arrays(contour: Outline, nodes: Index, arrays: dict[str, NDArray[np.float64] | Index]) -> ng.Mesh:
    """Restore the mesh that ``section.mesh`` has made of an outline and its nodes.

    Curved edges follow the same splines; the mesh generator is not called.

    Raises
    ------
    MeshError
        If the arrays are not those of a mesh of this outline.
    """
    points, triangles, segments, pieces = (arrays[name] for name in ("points", "triangles", "segments", "pieces"))
    right = [
        points.ndim == triangles.ndim == segments.ndim == 2,
        points.shape[1:] == (2,) and triangles.shape[1:] == (3,) and segments.shape[1:] == (2,),
        pieces.shape == segments.shape[:1],
        *(_below(index, n) for index, n in ((triangles, len(points)), (segments, len(points)), (pieces, len(nodes)))),
        _below(nodes, len(contour)) and len(pieces) > 0,
        bool(np.isfinite(points).all()),
    ]
    if not all(right):
        raise MeshError("the arrays are not those of a mesh of this outline")
    mesh = ngm.Mesh(2)
    mesh.SetGeometry(section.geometry(section.face(contour, nodes)))
    mesh.AddPoints(np.column_stack([points, np.zeros(len(points))]))
    mesh.Add(ngm.FaceDescriptor(surfnr=1, domin=0, domout=0, bc=1))
    mesh.SetMaterial(1, section.MATERIAL)
    mesh.AddElements(dim=2, index=1, data=triangles.astype(np.int32), base=0)
    for number, node in enumerate(nodes, start=1):
        piece = ngm.EdgeDescriptor()
        piece.edgenr, piece.name = number, contour.names[node]
        piece.index, piece.fdindex, piece.domin, piece.surfnr = 1, 1, 1, (1, 0)
        mesh.Add(piece)
    for run in np.split(np.arange(len(pieces)), np.flatnonzero(np.diff(pieces)) + 1):
        mesh.AddElements(dim=1, index=int(pieces[run[0]]) + 1, data=segments[run].astype(np.int32), base=0)
    result = ng.Mesh(mesh)
    result.Curve(section.CURVE)
    return result


def _below(index: NDArray[np.float64] | Index, count: int) -> bool:
    """Whether all are numbers of one of so many things."""
    return index.dtype.kind == "i" and bool(((index >= 0) & (index < count)).all())
