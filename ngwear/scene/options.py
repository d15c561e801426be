"""How wear is integrated, and what a run keeps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ngwear.errors import check_fields, require


@dataclass(frozen=True, kw_only=True)
class Wear:
    """How the worn depth is integrated, and what becomes of the mesh.

    The nodes follow the worn outline, those inside smoothly; a mesh can do so until its elements are squeezed or folded
    (``Body.move_to``). With ``remesh`` other than ``"due"`` it is fine at once wherever the wear may take the contact.

    Parameters
    ----------
    scheme : str
        ``"implicit"`` (backward Euler inside the contact law, stable for every step) or ``"explicit"``.
    step : str
        ``"jump"``: as many cycles at once as ``Accuracy.wear_error`` allows; ``"fixed"``: ``max_jump``, fewer where so
        many fail; ``"each"``: every stroke.
    max_jump : int or None
        Most cycles at once; what a cycle wears bounds them unless it is given.
    remesh : str
        ``"due"``: a new mesh as soon as another would be better for the present contact; ``"limit"``: once the nodes
        cannot be moved any further; ``"never"``: the run gives up there.
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
        says = "is missing: step = 'fixed' takes so many cycles at once"
        require(most is not None or self.step != "fixed", "wear.max_jump", most, says)
        require(
            self.remesh in ("due", "limit", "never"), "wear.remesh", self.remesh, "must be 'due', 'limit' or 'never'"
        )


@dataclass(frozen=True, kw_only=True)
class Save:
    """What a run keeps besides one line a step.

    Parameters
    ----------
    strokes : sequence of int
        Strokes that a jump must not pass over, so that outline and pressure are kept just there.
    vtk : bool
        Whether the deformed mesh is written for ParaView at these strokes and at the end.
    """

    strokes: Sequence[int] = ()
    vtk: bool = False

    def __post_init__(self) -> None:
        check_fields(self, "save")
        require(all(n > 0 for n in self.strokes), "save.strokes", self.strokes, "must be whole numbers above 0")
