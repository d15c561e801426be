"""Boundary conditions other than contact: pressure of a sealed fluid, and supports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ngwear.errors import check_fields, require

FLUID = "fluid"  # name of the only inlet
GO_ON, END = "go on", "end"
AMBIENT, TRAPPED = "ambient", "trapped"


@dataclass(frozen=True, kw_only=True)
class Fluid:
    """Pressure of sealed fluids on edges of the part, from one inlet or several.

    Parameters
    ----------
    edges : sequence of str
        Edges that a fluid may wet; they form one connected piece.
    inlet : sequence of str, or mapping of str to sequence of str
        Edges where the fluid comes in: from their middle, or that of their longest piece without contact, it reaches
        the first points in contact, in both directions. A surface that touches these edges alone, such as a wall beside
        the inlet, does not stop it. Several inlets, such as the two sides of a seal, have names, each with its edges;
        ``Stroke.pressure`` then gives the pressure of each.
    blow_by : str
        What a run does where no contact holds the fluid: "go on" (default; the results are then for a seal that does
        not open) or "end".
    pockets : str
        What a pocket holds that contacts cut off from the fluid, such as the valley between the two lobes of an X-ring:
        "ambient" (default), or "trapped": the fluid that was there, at its pressure, as far as the contacts carry it.
    leak_pressure : bool
        Whether to compute the fluid pressure that the contacts hold. The mesh is then also refined where the fluid
        meets a contact, because the contact pressure often has its peak there.
    """

    edges: Sequence[str]
    inlet: Sequence[str] | Mapping[str, Sequence[str]]
    leak_pressure: bool = False
    blow_by: str = GO_ON
    pockets: str = AMBIENT

    def __post_init__(self) -> None:
        check_fields(self, "fluid")
        require(self.blow_by in (GO_ON, END), "fluid.blow_by", self.blow_by, f"must be '{GO_ON}' or '{END}'")
        remedy = f"must be '{AMBIENT}' or '{TRAPPED}'"
        require(self.pockets in (AMBIENT, TRAPPED), "fluid.pockets", self.pockets, remedy)
        known: set[str] = set()
        require(bool(self.inlets), "fluid.inlet", self.inlet, "must name some of the fluid's edges")
        for name, edges in self.inlets.items():
            place = "fluid.inlet" if name == FLUID else f"fluid.inlet.{name}"
            remedy = f"must name some of the fluid's edges {list(self.edges)}"
            require(bool(edges) and set(edges) <= set(self.edges), place, list(edges), remedy)
            remedy = "belongs to another inlet, too: an edge can hold one pressure only"
            require(known.isdisjoint(edges), place, list(edges), remedy)
            known.update(edges)

    @property
    def inlets(self) -> dict[str, Sequence[str]]:
        """Edges of each inlet, by its name; the only inlet is named "fluid"."""
        return dict(self.inlet) if isinstance(self.inlet, Mapping) else {FLUID: self.inlet}


@dataclass(frozen=True, kw_only=True)
class Support:
    """Edges whose displacement is zero in x, y or both."""

    edges: Sequence[str]
    x: bool = True
    y: bool = True

    def __post_init__(self) -> None:
        check_fields(self, "support")
