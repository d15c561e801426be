"""Describe a scene: which effects it simulates and neglects, and whether a neglected effect matters."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.text import lines
from ngwear.scene.pin_scene import PinScene
from ngwear.scene.scene import Scene


class Explanation(Mapping[str, Any]):
    """Description of a scene: a mapping with the keys of ``ngwear explain --json``; ``print`` shows it as text."""

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
        """The description as JSON text."""
        return json.dumps(dict(self), indent=2)


def explain(
    scene: Scene | PinScene, *, assumed: Assumed | None = None, on_mount: Callable[[float], None] | None = None
) -> Explanation:
    """Describe a scene: its effects with their cost, and neglected effects with dimensionless numbers and a verdict.

    Parameters
    ----------
    scene : Scene or PinScene
        A wear scene is mounted once on a coarse mesh, to find its contact pressures.
    assumed : Assumed or None
        Constants that the scene does not give; default values otherwise.
    on_mount : callable or None
        Called with the completed fraction of the mounting.

    Returns
    -------
    Explanation

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
