"""What can go wrong, one class for each kind of remedy."""

from __future__ import annotations

from typing import Any


class NgwearError(Exception):
    """Base of every error that ngwear raises on purpose."""


class SceneError(NgwearError, ValueError):
    """The scene asks for something impossible.

    Parameters
    ----------
    place : str
        Path in the scene, such as ``contact[0].friction``.
    value : object
        What was found there.
    remedy : str
        The allowed range and how to mend it.
    """

    def __init__(self, place: str, value: Any, remedy: str) -> None:
        self.place, self.value, self.remedy = place, value, remedy
        super().__init__(f"{place} = {value!r}: {remedy}")


def require(ok: bool, place: str, value: object, remedy: str) -> None:
    """Raise SceneError for what stands at a place in the scene unless it is all right."""
    if not ok:
        raise SceneError(place, value, remedy)


class GeometryError(NgwearError):
    """A contour is not a simple, counter-clockwise, closed curve, or has been worn through."""


class MeshError(NgwearError):
    """A mesh does not pass the gates on area, names, smallest angle or Jacobian."""


class ConvergenceError(NgwearError):
    """No equilibrium was found; ``report`` holds the last iterations."""

    def __init__(self, message: str, report: Any = None) -> None:
        self.report = report
        super().__init__(message if report is None else f"{message}\n{report}")


class ResultError(NgwearError):
    """A result folder or file cannot be read, written or continued."""
