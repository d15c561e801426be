"""A file of plain data: a zip of NumPy arrays with its format, format version and ngwear version."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.files.plain_data import Packer, Unpacker
from ngwear.files.version import VERSION

ABOUT, TREE, VALUES = "about", "tree", "values {}"
Members = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Format:
    """A kind of file, and the remedy if one cannot be read.

    Parameters
    ----------
    name : str
        Such as ``"checkpoint"``.
    version : int
        Increased with each change of the stored data.
    remedy : str
        Advice for a damaged file, or one of another version.
    """

    name: str
    version: int
    remedy: str


def packed(content: Any, kind: Format, classes: Iterable[type] = ()) -> Members:
    """The members of the file.

    Raises
    ------
    ResultError
        If the content is not plain data (``plain_data``).
    """
    packer = Packer(classes)
    tree = packer.pack(content)
    about = {"format": f"ngwear {kind.name}", "version": kind.version, "ngwear": VERSION}
    texts = {ABOUT: json.dumps(about), TREE: json.dumps(tree, separators=(",", ":"))}
    members: Members = {name: np.frombuffer(text.encode("ascii"), dtype=np.uint8) for name, text in texts.items()}
    return members | {VALUES.format(i): array for i, array in enumerate(packer.arrays())}


def write(file: IO[bytes], members: Members) -> None:
    """Write the members to an open file; ``numpy.load`` can read it, too."""
    with zipfile.ZipFile(file, "w") as archive:
        for name, array in members.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, array, allow_pickle=False)


def read(path: Path, kind: Format, classes: Iterable[type] = ()) -> Any:
    """Read a file. Nothing in it is executed: it gives only plain data and objects of the listed classes.

    Raises
    ------
    ResultError
        If it is damaged, of another kind, or of another version; the message says the remedy.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            about = json.loads(_member(archive, ABOUT).tobytes())
            found, version, made_by = about["format"], about["version"], about["ngwear"]
            if found == f"ngwear {kind.name}" and version == kind.version:
                arrays = [_member(archive, VALUES.format(i)) for i in range(len(archive.namelist()) - 2)]
                tree = json.loads(_member(archive, TREE).tobytes())
                return Unpacker(arrays, classes).unpack(tree)
    except Exception as error:  # damaged bytes may raise any error
        found = f"there is no {error}" if isinstance(error, KeyError) else error
        raise ResultError(f"{path} cannot be read as a {kind.name} ({found}); {kind.remedy}") from error
    if found != f"ngwear {kind.name}":
        raise ResultError(f"{path} is not a {kind.name} of ngwear: its format is {found!r}; {kind.remedy}")
    raise other_version(path, kind, version, made_by)


def other_version(path: Path, kind: Format, found: object, made_by: object) -> ResultError:
    """The error for a file of an older or newer version."""
    return ResultError(
        f"{path} is a {kind.name} of version {found}, written by ngwear {made_by}; this is ngwear {VERSION}, which "
        f"reads version {kind.version}: {kind.remedy}, or take ngwear {made_by}"
    )


def _member(archive: zipfile.ZipFile, name: str) -> NDArray[Any]:
    with archive.open(f"{name}.npy") as member:
        return np.lib.format.read_array(member, allow_pickle=False)
