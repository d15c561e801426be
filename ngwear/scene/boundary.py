"""Boundary conditions other than contact: pressure of a sealed fluid, and supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ngwear.errors import check_fields


@dataclass(frozen=True, kw_only=True)
class Fluid:
    """Pressure of a sealed fluid on edges of the part.

    Parameters
    ----------
    edges : sequence of str
        Edges that the fluid may wet; they form one connected piece.
    inlet : sequence of str
        Edges that are always wetted; from there the fluid reaches the first point in contact.
    leak_pressure : bool
        Whether to compute the fluid pressure that the contacts hold. The mesh is then also refined where the fluid
        meets a contact, because the contact pressure often has its peak there.
    """

    edges: Sequence[str]
    inlet: Sequence[str]
    leak_pressure: bool = False

    def __post_init__(self) -> None:
        check_fields(self, "fluid")


@dataclass(frozen=True, kw_only=True)
class Support:
    """Edges whose displacement is zero in x, y or both."""

    edges: Sequence[str]
    x: bool = True
    y: bool = True

    def __post_init__(self) -> None:
        check_fields(self, "support")
