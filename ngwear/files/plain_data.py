"""Convert plain data to JSON text and arrays, and back, exactly.

Plain data are numbers, text, None, lists, tuples, dicts, NumPy arrays, and objects of listed classes. A file cannot
create other objects: no name in a file is imported or called.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError

AnyArray = NDArray[Any]
AS_THEY_ARE = (type(None), bool, int, float, str)
KINDS = "biufcSUmM"  # of arrays: whatever has no Python objects in it
SHORT = 8  # a list of numbers with fewer stays text: an array has a header of 128 bytes
LARGEST = 2**63  # whole numbers from here on stay text


@runtime_checkable
class Storable(Protocol):
    """An object that defines its stored data itself; dataclasses store all of their fields."""

    def to_data(self) -> dict[str, Any]:
        """The data from which ``from_data`` restores the object."""

    @classmethod
    def from_data(cls, data: dict[str, Any]) -> Self:
        """Restore the object."""


def by_name(classes: Iterable[type]) -> dict[str, type]:
    """The classes by their names in a file.

    Raises
    ------
    TypeError
        If a class is not a dataclass, an enumeration or ``Storable``, or two have the same name.
    """
    named: dict[str, type] = {}
    for cls in classes:
        if not isinstance(cls, type) or not (is_dataclass(cls) or issubclass(cls, enum.Enum | Storable)):
            raise TypeError(f"{cls!r} must be a dataclass or an enumeration")
        if named.setdefault(cls.__name__, cls) is not cls:
            raise TypeError(f"two classes are named {cls.__name__}")
    return named


class Packer:
    """Converts values to JSON data, and their arrays to a few long arrays, one for each number type.

    Parameters
    ----------
    classes : iterable of type
        Classes of objects that may occur.
    """

    def __init__(self, classes: Iterable[type] = ()) -> None:
        self._names = {cls: name for name, cls in by_name(classes).items()}
        self._pieces: dict[np.dtype[Any], list[AnyArray]] = {}
        self._sizes: dict[np.dtype[Any], int] = {}
        self._done: dict[int, tuple[AnyArray, list[Any]]] = {}  # keeps the array, so that its id stays unique

    def arrays(self) -> list[AnyArray]:
        """The long arrays of all values packed so far."""
        return [np.concatenate(pieces, dtype=kind) for kind, pieces in self._pieces.items()]

    def pack(self, value: Any) -> Any:
        """Convert a value to JSON data.

        Raises
        ------
        ResultError
            If the value is not plain data, or an object of a class that is not listed.
        """
        kind = type(value)
        if kind in AS_THEY_ARE:
            return value
        if kind is list:
            return self._items(value)
        if kind is tuple:
            return {"tuple": self._items(value)}
        if kind is dict:
            if all(type(key) is str for key in value):
                return {"dict": {key: self.pack(item) for key, item in value.items()}}
            return {"pairs": [[self.pack(key), self.pack(item)] for key, item in value.items()]}
        if kind is np.ndarray and value.dtype.kind in KINDS:
            return {"array": self._put(value)}
        if isinstance(value, np.generic) and value.dtype.kind in KINDS:
            return {"scalar": self._put(np.asarray(value))}
        name = self._names.get(kind)
        if name is None:
            raise ResultError(
                f"an object of the class {kind.__module__}.{kind.__qualname__} cannot be written: files hold numbers, "
                "text, lists, tuples, dicts, NumPy arrays, and objects of dataclasses that are listed as 'classes'"
            )
        if isinstance(value, enum.Enum):
            return {"enum": [name, value.name]}
        stored = (
            value.to_data() if isinstance(value, Storable) else {f.name: getattr(value, f.name) for f in fields(value)}
        )
        return {"object": [name, {key: self.pack(item) for key, item in stored.items()}]}

    def _items(self, values: list[Any] | tuple[Any, ...]) -> Any:
        kinds = set(map(type, values))
        if len(values) >= SHORT and (
            kinds == {float} or (kinds == {int} and all(-LARGEST <= value < LARGEST for value in values))
        ):
            return {"numbers": self._put(np.array(values, dtype=float if kinds == {float} else np.int64))}
        if kinds == {dict} and len(values) > 1:
            keys = list(values[0])
            if keys and all(type(key) is str for key in keys) and all(list(row) == keys for row in values):
                return {"table": {key: self._items([row[key] for row in values]) for key in keys}}
        return [self.pack(value) for value in values]

    def _put(self, array: AnyArray) -> list[Any]:
        """Store an array; return number of the long array, first index, shape and memory order."""
        if id(array) in self._done:
            return self._done[id(array)][1]
        pieces = self._pieces.setdefault(array.dtype, [])
        which, first = list(self._pieces).index(array.dtype), self._sizes.get(array.dtype, 0)
        in_columns = array.flags.fnc
        where = [which, first, list(array.shape), "F" if in_columns else "C"]
        pieces.append(array.ravel(order="F" if in_columns else "C"))
        self._sizes[array.dtype] = first + array.size
        self._done[id(array)] = array, where
        return where


class Unpacker:
    """Restores values from the data of a ``Packer``.

    Parameters
    ----------
    arrays : iterable of array
        The long arrays, in their order.
    classes : iterable of type
        Classes of objects that may be created.
    """

    def __init__(self, arrays: Iterable[AnyArray], classes: Iterable[type] = ()) -> None:
        self._classes = by_name(classes)
        self._arrays = dict(enumerate(arrays))
        self._done: dict[tuple[Any, ...], AnyArray] = {}

    def unpack(self, packed: Any) -> Any:
        """Restore a value.

        Raises
        ------
        ValueError, KeyError, TypeError, AttributeError
            If these are not data of a ``Packer``, or another version of a class has been stored.
        """
        if type(packed) in AS_THEY_ARE:
            return packed
        if isinstance(packed, list):
            return [self.unpack(item) for item in packed]
        ((tag, content),) = packed.items()
        match tag:
            case "tuple":
                return tuple(self.unpack(content))
            case "dict":
                return {key: self.unpack(item) for key, item in content.items()}
            case "pairs":
                return {self.unpack(key): self.unpack(item) for key, item in content}
            case "numbers":
                return self._take(content).tolist()
            case "table":
                columns = [self.unpack(column) for column in content.values()]
                return [dict(zip(content, row, strict=True)) for row in zip(*columns, strict=True)]
            case "array":
                return self._take(content)
            case "scalar":
                return self._take(content)[()]
            case "enum":
                return self._class(content[0], enum.Enum)[content[1]]
            case "object":
                return self._object(*content)
        raise ValueError(f"{tag!r} is no kind of plain data")

    def _class(self, name: str, base: type = object) -> Any:
        cls = self._classes.get(name)
        if cls is None or not issubclass(cls, base):
            raise ValueError(f"it holds an object of the class {name!r}, which has no place here")
        return cls

    def _object(self, name: str, packed: Mapping[str, Any]) -> Any:
        cls = self._class(name)
        stored = {key: self.unpack(item) for key, item in packed.items()}
        if issubclass(cls, Storable):
            return cls.from_data(stored)
        wanted = [f.name for f in fields(cls)]
        if set(stored) != set(wanted):
            raise ValueError(f"the fields of its {name} are {sorted(stored)}, not {sorted(wanted)}")
        made = object.__new__(cls)  # without its constructor, which may change values
        for key in wanted:
            object.__setattr__(made, key, stored[key])
        return made

    def _take(self, where: list[Any]) -> AnyArray:
        which, first, shape, order = where
        key = (which, first, tuple(shape), order)
        if key not in self._done:
            size = int(np.prod(shape, dtype=object)) if shape else 1
            whole = self._arrays[which]
            if first < 0 or size < 0 or first + size > len(whole):
                raise ValueError("an array lies beyond what the file holds")
            self._done[key] = whole[first : first + size].reshape(shape, order=order).copy(order="K")
        return self._done[key]
