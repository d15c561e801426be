"""Errors of ngwear, one class for each kind of remedy, and the checks of the values in a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields
from numbers import Integral, Real
from typing import Any

LARGEST, SMALLEST = 1e15, 1e-30  # limits of a number in a scene, in any of the units


class NgwearError(Exception):
    """Base class of all errors of ngwear."""


class SceneError(NgwearError, ValueError):
    """A value in the scene, or an argument, is wrong or contradicts another one.

    Parameters
    ----------
    place : str
        Path in the scene, such as ``contact[0].friction``.
    value : object
        The value that was found there.
    remedy : str
        The allowed range and how to correct the value.
    """

    def __init__(self, place: str, value: Any, remedy: str) -> None:
        self.place, self.value, self.remedy = place, value, remedy
        super().__init__(f"{place} = {value!r}: {remedy}")


def require(ok: bool, place: str, value: object, remedy: str) -> None:
    """Raise SceneError with the place, the value and the remedy unless ``ok`` is True."""
    if not ok:
        raise SceneError(place, value, remedy)


def check_fields(record: Any, place: str) -> None:
    """Convert the fields of a dataclass to the types of their annotations: lists to tuples, integers to floats.

    Only text, names, numbers and booleans are converted. Fields with their default value are not changed. nan is not
    changed either: the check of the field's own range refuses it.

    Raises
    ------
    SceneError
        If a value has another type, or a number is not finite.
    """
    for f in fields(record):
        value = getattr(record, f.name)
        number = isinstance(value, float)  # an infinite default is another object in another process
        if value is f.default or (number and (value == f.default or math.isnan(value))):
            continue
        object.__setattr__(record, f.name, typed(f"{place}.{f.name}", value, str(f.type)))


def typed(place: str, value: Any, kind: str) -> Any:
    """Return the value converted to the type that an annotation names; types that no scene file holds pass unchanged.

    Raises
    ------
    SceneError
        If the value has another type, or is a number that is not finite.
    """
    if value is None and kind.endswith("| None"):
        return None
    kind, either, named = kind.partition(" | Mapping[str, ")
    if either and isinstance(value, Mapping):
        return {str(name): typed(f"{place}.{name}", one, named.removesuffix("]")) for name, one in value.items()}
    for inner, one, example in _SEQUENCES:
        if kind.startswith((f"Sequence[{inner}]", f"tuple[{inner}")):
            values: Any = value.tolist() if hasattr(value, "tolist") else value
            right = isinstance(values, Sequence) and not isinstance(values, str)
            if not right or (inner == "str" and not all(isinstance(v, str) for v in values)):
                raise SceneError(place, value, f"must be a list of {one}, such as {example}")
            if kind == "tuple[float, float]" and len(values) != 2:
                raise SceneError(place, value, "must be two numbers [x, y]")
            return tuple(typed(f"{place}[{i}]", v, inner) for i, v in enumerate(values))
    if kind.startswith("bool") and not isinstance(value, bool):
        raise SceneError(place, value, "must be true or false")
    if kind in ("str", "str | None") and not isinstance(value, str):
        raise SceneError(place, value, "must be a text in quotes")
    if kind in ("int", "int | None"):
        if isinstance(value, bool) or not isinstance(value, Integral):
            raise SceneError(place, value, "must be a whole number")
        if not abs(int(value)) < LARGEST:
            raise SceneError(place, value, f"must be a whole number below {LARGEST:g}")
        return int(value)
    if kind in ("float", "float | None"):
        if isinstance(value, bool) or not isinstance(value, Real):
            raise SceneError(place, value, "must be a number")
        size: Any = abs(value)  # not yet a float: an integer may be too large for one
        number = float(value) if size < LARGEST else math.inf
        if not math.isfinite(number):
            raise SceneError(place, value, f"must be a finite number (below {LARGEST:g})")
        if 0 < abs(number) < SMALLEST:
            raise SceneError(place, value, f"must be 0, or a number above {SMALLEST:g}")
        return number
    return value


_SEQUENCES = (
    ("str", "names", '["lip"]'),
    ("int", "whole numbers", "[50, 100]"),
    ("float", "numbers", "[3.0, 10.0]"),
)


class GeometryError(NgwearError):
    """An outline is not a simple, counter-clockwise, closed curve, or the part is worn through."""


class MeshError(NgwearError):
    """A mesh fails a check: of its area, edge names, smallest angle or Jacobian."""


class ConvergenceError(NgwearError):
    """No equilibrium was found; ``report`` holds the last Newton iterations, ``cause`` what the part itself shows."""

    def __init__(self, message: str, report: Any = None, *, cause: str = "") -> None:
        self.report, self.cause = report, cause
        said = report is None or message.endswith(f"\n{report}")
        super().__init__(message if said else f"{message}\n{report}")

    def with_words(self, before: str = "", after: str = "") -> ConvergenceError:
        """The same error with words before and after its sentences; those of the report stay at the end."""
        found = str(self).removesuffix(f"\n{self.report}")
        return ConvergenceError(f"{before}{found}{after}", self.report, cause=self.cause)


class ResultError(NgwearError):
    """A result folder or file cannot be read, written or continued."""
