"""What else acts on a part's edges: a sealed fluid, and supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ngwear.errors import check_fields


@dataclass(frozen=True, kw_only=True)
class Fluid:
    """Where a sealed fluid may go: ``edges`` in one piece, ``inlet`` always wetted.

    ``leak_pressure`` asks what fluid pressure the contacts hold; meshes are then fine where the fluid meets them, too:
    at its front, as at a punch's edge, a contact often presses hardest.
    """

    edges: Sequence[str]
    inlet: Sequence[str]
    leak_pressure: bool = False

    def __post_init__(self) -> None:
        check_fields(self, "fluid")


@dataclass(frozen=True, kw_only=True)
class Support:
    """Edges held at their place in x, y or both."""

    edges: Sequence[str]
    x: bool = True
    y: bool = True

    def __post_init__(self) -> None:
        check_fields(self, "support")
