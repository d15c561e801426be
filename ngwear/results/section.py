"""The loaded section of one saved stroke: deformed elements, fields by name, contact pressures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Arrays = Mapping[str, NDArray[np.generic]]

STRESS, STRETCH = "stress xx, yy, xy, zz [MPa]", "maximum principal stretch [-]"
VON_MISES = "von Mises stress [MPa]"


@dataclass(frozen=True)
class SectionContact:
    """One contact of a loaded section.

    Attributes
    ----------
    place : array, shape (k, 2)
        Deformed nodes of the edges that may touch, in outline order [mm].
    pressure : array, shape (k,)
        Cauchy pressure at these nodes [MPa].
    edges : array of int, shape (m, 2)
        Start and end node of each mesh edge.
    moved : array, shape (2,)
        Displacement of a surface under force from its place in the scene [mm].
    turned : float
        Movement of the surface along itself; its worn profile moves with it [mm].
    """

    place: Array
    pressure: Array
    edges: Index
    moved: Array
    turned: float


@dataclass(frozen=True)
class Section:
    """The section of a part under load. Stresses are Cauchy stresses, averaged between elements.

    Attributes
    ----------
    points : array, shape (n, 2)
        Deformed nodes of the elements: vertices, edge midpoints, centres of quadrilaterals [mm].
    displacement : array, shape (n, 2)
        Displacement of the nodes [mm].
    triangles, quadrilaterals : array of int, shapes (nt, 6) and (nq, 9)
        Corners of each, the midpoint of the edge that begins at each corner, and a quadrilateral's centre.
    stress : array, shape (nv, 4)
        Stresses xx, yy, xy and zz at the vertices, which come first among the nodes [MPa]; zz is the hoop stress of a
        ring, or the stress normal to a plane section.
    stretch : array, shape (nv,)
        Maximum principal stretch at the vertices [-].
    wetted : dict of float to array of int, shape (m, 3)
        Start, midpoint and end of each mesh edge under a fluid pressure, by this pressure [MPa].
    held : array of int, shape (m, 3)
        The same of each mesh edge on a support.
    contacts : dict of str to SectionContact
    """

    points: Array
    displacement: Array
    triangles: Index
    quadrilaterals: Index
    stress: Array
    stretch: Array
    wetted: dict[float, Index]
    held: Index
    contacts: dict[str, SectionContact]

    @classmethod
    def of(cls, arrays: Arrays) -> Section:
        """Build from the arrays that a run saves at a stroke (``Snapshot.section``).

        Raises
        ------
        KeyError
            If an array is missing.
        """

        def real(name: str) -> Array:
            return np.asarray(arrays[name], dtype=np.float64)

        def whole(name: str) -> Index:
            return np.asarray(arrays[name], dtype=np.intp)

        ending = ": moved by [mm]"
        names = [name.removesuffix(ending) for name in arrays if name.endswith(ending)]
        wet = "wetted edges" in arrays
        return cls(
            points=real("points [mm]"),
            displacement=real("displacement [mm]"),
            triangles=whole("triangles"),
            quadrilaterals=whole("quadrilaterals"),
            stress=real(STRESS),
            stretch=real(STRETCH),
            wetted=_wetted(arrays) if wet else {},
            held=whole("held edges") if "held edges" in arrays else np.empty((0, 3), dtype=np.intp),
            contacts={
                name: SectionContact(
                    real(f"{name}: place [mm]"),
                    real(f"{name}: pressure [MPa]"),
                    whole(f"{name}: edges"),
                    real(f"{name}{ending}"),
                    float(real(f"{name}: turned by [mm]")),
                )
                for name in names
            },
        )

    @property
    def fluid_pressure(self) -> float:
        """Highest fluid pressure [MPa]."""
        return max(self.wetted, default=0.0)

    def field(self, name: str) -> Array:
        """Values of a field at the vertices, shape (nv,), by its name in ``FIELDS``."""
        return FIELDS[named(name)](self)

    @property
    def border(self) -> Index:
        """Start, midpoint and end of each boundary edge of the mesh, shape (m, 3)."""
        edges = self.edges
        _, first, count = np.unique(edges[:, 1], return_index=True, return_counts=True)
        return edges[first[count == 1]]

    @property
    def edges(self) -> Index:
        """Start, midpoint and end of each edge of each element, shape (m, 3)."""
        found = []
        for nodes, n in ((self.triangles, 3), (self.quadrilaterals, 4)):
            corners = nodes[:, :n]
            found.append(np.stack([corners, nodes[:, n : 2 * n], np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 3))
        return np.concatenate(found)

    def loops(self) -> list[Index]:
        """The boundary as closed lines: start and midpoint of the edges in turn, shape (m, 2) each."""
        border = self.border
        after: dict[int, list[int]] = {}
        for row, start in enumerate(border[:, 0].tolist()):
            after.setdefault(start, []).append(row)
        loops = []
        while after:
            start = next(iter(after))
            loop, here = [], start
            while here in after:
                row = after[here].pop()
                if not after[here]:
                    del after[here]
                loop.append(border[row, :2])
                here = int(border[row, 2])
            loops.append(np.array(loop))
        return loops


def _wetted(arrays: Arrays) -> dict[float, Index]:
    """``Section.wetted``; a file written before there were several inlets names none."""
    edges = np.asarray(arrays["wetted edges"], dtype=np.intp)
    inlet = np.asarray(arrays.get("wetted from inlet", np.zeros(len(edges))), dtype=np.intp)
    whole = np.asarray(arrays["wetted share [-]"], dtype=np.float64) > 0.5
    pressures = np.atleast_1d(np.asarray(arrays["fluid pressure [MPa]"], dtype=np.float64)).tolist()
    found: dict[float, Index] = {}
    for k, pressure in enumerate(pressures):
        mine = edges[whole & (inlet == k)]
        found[pressure] = np.vstack([found[pressure], mine]) if pressure in found else mine
    return found


def _principal(section: Section) -> tuple[Array, Array]:
    """Largest and smallest of the three principal stresses [MPa]."""
    xx, yy, xy, zz = section.stress.T
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    return np.maximum(middle + radius, zz), np.minimum(middle - radius, zz)


def _von_mises(section: Section) -> Array:
    xx, yy, xy, zz = section.stress.T
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)


FIELDS: dict[str, Callable[[Section], Array]] = {
    VON_MISES: _von_mises,
    "mean pressure [MPa]": lambda s: -(s.stress[:, 0] + s.stress[:, 1] + s.stress[:, 3]) / 3,
    "maximum principal stress [MPa]": lambda s: _principal(s)[0],
    "minimum principal stress [MPa]": lambda s: _principal(s)[1],
    "maximum shear stress [MPa]": lambda s: 0.5 * (_principal(s)[0] - _principal(s)[1]),
    "normal stress x [MPa]": lambda s: s.stress[:, 0],
    "normal stress y [MPa]": lambda s: s.stress[:, 1],
    "shear stress xy [MPa]": lambda s: s.stress[:, 2],
    "hoop or out-of-plane stress [MPa]": lambda s: s.stress[:, 3],
    STRETCH: lambda s: s.stretch,
    "displacement x [mm]": lambda s: s.displacement[: len(s.stress), 0],
    "displacement y [mm]": lambda s: s.displacement[: len(s.stress), 1],
}


def named(field: str) -> str:
    """Full name of a field, which may be given without its unit.

    Raises
    ------
    ResultError
        If the name is unknown; the message lists the known ones.
    """
    for name in FIELDS:
        if field.strip().lower() in (name.lower(), name.rsplit(" [", 1)[0].lower()):
            return name
    known = ", ".join(f"'{name.rsplit(' [', 1)[0]}'" for name in FIELDS)
    raise ResultError(f"no field is called '{field}': choose one of {known}")
