"""Options of a scene: how wear is integrated, and which results are saved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ngwear.errors import check_fields, require


@dataclass(frozen=True, kw_only=True)
class Wear:
    """How the worn depth is integrated, and when the section is remeshed.

    Boundary nodes move with the worn outline, inner nodes follow smoothly, until elements are too distorted
    (``Body.move_to``). With ``remesh`` other than ``"due"`` the first mesh is fine wherever the contact may spread.

    Parameters
    ----------
    scheme : str
        ``"implicit"`` (wear inside the contact law, stable for every step length) or ``"explicit"``.
    step : str
        ``"jump"``: one solve stands for as many cycles as ``Accuracy.wear_error`` allows; ``"fixed"``: for
        ``max_jump`` cycles, fewer if such a step fails; ``"each"``: every stroke is solved.
    max_jump : int or None
        Largest number of cycles in one step; default: limited by the error only.
    remesh : str
        ``"due"``: remesh as soon as the mesh is too coarse for the present contact; ``"limit"``: when the nodes
        cannot move any further; ``"never"``: the run gives up then.
    """

    scheme: str = "implicit"
    step: str = "jump"
    max_jump: int | None = None
    remesh: str = "due"

    def __post_init__(self) -> None:
        check_fields(self, "wear")
        require(self.scheme in ("implicit", "explicit"), "wear.scheme", self.scheme, "must be 'implicit' or 'explicit'")
        require(self.step in ("jump", "fixed", "each"), "wear.step", self.step, "must be 'jump', 'fixed' or 'each'")
        most = self.max_jump
        require(most is None or most >= 1, "wear.max_jump", most, "must be at least 1")
        says = "is missing: step = 'fixed' needs the number of cycles of a step"
        require(most is not None or self.step != "fixed", "wear.max_jump", most, says)
        require(
            self.remesh in ("due", "limit", "never"), "wear.remesh", self.remesh, "must be 'due', 'limit' or 'never'"
        )


@dataclass(frozen=True, kw_only=True)
class Save:
    """What a run saves besides one row of ``series.csv`` for each solve.

    Parameters
    ----------
    strokes : sequence of int
        Numbers of strokes that are solved and saved with outline, pressure and loaded section; no jump passes them.
    vtk : bool
        Whether to write the deformed mesh for ParaView at the end.
    """

    strokes: Sequence[int] = ()
    vtk: bool = False

    def __post_init__(self) -> None:
        check_fields(self, "save")
        require(all(n > 0 for n in self.strokes), "save.strokes", self.strokes, "must be whole numbers above 0")
