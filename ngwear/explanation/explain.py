"""One verb: say what a scene simulates, what it leaves out, and whether that matters."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.text import lines
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene


class Explanation(Mapping[str, Any]):
    """A description of a scene by its parts, as ``ngwear explain --json`` prints it; printed, that command's text."""

    def __init__(self, found: Mapping[str, Any]) -> None:
        self._found = found

    def __getitem__(self, name: str) -> Any:
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __str__(self) -> str:
        return "\n".join(lines(self))

    @property
    def json(self) -> str:
        """The description as text in JSON."""
        return json.dumps(dict(self), indent=2)


def explain(
    scene: Scene | PinScene, *, assumed: Assumed | None = None, on_mount: Callable[[float], None] | None = None
) -> Explanation:
    """Describe a scene: each effect and what it brings; each that is left out, with the numbers that judge it.

    Parameters
    ----------
    scene : Scene or PinScene
        A scene of wear is mounted once on a coarse mesh for its contact pressures.
    assumed : Assumed or None
        Constants that the scene does not give.
    on_mount : callable or None
        Called with the fraction of the mounting that is done.

    Raises
    ------
    MeshError
        If the section cannot be meshed.
    """
    if isinstance(scene, PinScene):
        from ngwear.explanation.explain_pin import explain_pin

        return Explanation(explain_pin(scene, assumed=assumed))
    from ngwear.explanation.explain_wear import explain_wear

    return Explanation(explain_wear(scene, assumed=assumed, on_mount=on_mount))
