"""Plain data in a file and back: every bit, and nothing but the classes that are listed."""

import enum
import io
import json
import math
import random
import struct
import zipfile
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from ngwear.errors import ResultError
from ngwear.files.archive import Format, packed, read, write
from ngwear.files.plain_data import by_name

KIND = Format("test", 3, "throw it away")


class Colour(enum.Enum):
    RED = "red"
    BLUE = 2


class Fate(enum.IntEnum):
    HERE = 0
    GONE = 1


@dataclass(frozen=True)
class Point:
    x: float
    names: tuple[str, ...] = ()
    inner: object = None

    def __post_init__(self):
        raise AssertionError("reading calls no constructor")


@dataclass
class Slotted:
    __slots__ = ("a", "b")
    a: int
    b: list


class Own:
    """Says itself what of it is stored."""

    def __init__(self, value):
        self.value, self.double = value, 2 * value

    def to_data(self):
        return {"value": self.value}

    @classmethod
    def from_data(cls, data):
        return cls(data["value"])


CLASSES = (Colour, Fate, Point, Slotted, Own)


def point(x, names=(), inner=None):
    made = object.__new__(Point)
    for name, value in (("x", x), ("names", names), ("inner", inner)):
        object.__setattr__(made, name, value)
    return made


def through_a_file(content, path, classes=CLASSES):
    with path.open("wb") as file:
        write(file, packed(content, KIND, classes))
    return read(path, KIND, classes)


def same(a, b):
    """Whether both are the same in type and bits."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        layout = (a.dtype, a.shape, a.flags.c_contiguous, a.flags.f_contiguous)
        return layout == (b.dtype, b.shape, b.flags.c_contiguous, b.flags.f_contiguous) and a.tobytes() == b.tobytes()
    if isinstance(a, np.generic):
        return a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if isinstance(a, float):
        return struct.pack("d", a) == struct.pack("d", b)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, dict):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a.items(), b.items(), strict=True))
    if isinstance(a, Own):
        return same(a.value, b.value) and same(a.double, b.double)
    if isinstance(a, Point | Slotted):
        return all(same(getattr(a, name), getattr(b, name)) for name in type(a).__annotations__)
    return a == b


FLOATS = (0.0, -0.0, math.inf, -math.inf, math.nan, 5e-324, -1e-310, 0.1, 1 / 3, 1.7976931348623157e308, 1.0, 1e22)
WHOLE = (0, 1, -1, 2**62, -(2**63), 2**63, 10**40)
TEXTS = ("", "a", "µm²", "N/mm", "\udc80", "\0", 'qu"ote', "tuple")


def leaf(rng):
    kind = rng.randrange(9)
    if kind == 0:
        return rng.choice(FLOATS)
    if kind == 1:
        return rng.choice(WHOLE)
    if kind == 2:
        return rng.choice((True, False, None))
    if kind == 3:
        return rng.choice(TEXTS)
    if kind == 4:
        return rng.choice((Colour.RED, Colour.BLUE, Fate.GONE))
    if kind == 5:
        return rng.choice((np.float64(-0.0), np.float32(0.1), np.int8(-3), np.bool_(True), np.str_("x")))
    if kind == 6:
        return [rng.choice(FLOATS) for _ in range(rng.randrange(20))]
    if kind == 7:
        return [rng.choice(WHOLE[:5]) for _ in range(rng.randrange(20))]
    shape = tuple(rng.randrange(4) for _ in range(rng.randrange(4)))
    numbers = np.array([rng.choice(FLOATS) for _ in range(math.prod(shape))]).reshape(shape)
    types = ("f8", "i8", "?", "U3", "c16", ">f4", "i1")
    array = numbers if rng.random() < 0.5 else np.where(np.isfinite(numbers), numbers, 0).clip(-9, 9)
    array = array if array is numbers else array.astype(rng.choice(types))
    return np.asfortranarray(array) if rng.random() < 0.5 else array


def tree(rng, depth):
    if depth == 0 or rng.random() < 0.3:
        return leaf(rng)
    parts = [tree(rng, depth - 1) for _ in range(rng.randrange(4))]
    keys = [rng.choice((str(i), i, Fate.HERE if i == 0 else (i, "k"), True if i == 1 else float(i))) for i in range(4)]
    rows = [{"a [N/mm]": leaf(rng), "b": leaf(rng), "tuple": 0.5 * i} for i in range(rng.randrange(12))]
    return rng.choice(
        (
            parts,
            tuple(parts),
            dict(zip(TEXTS, parts, strict=False)),
            dict(zip(keys, parts, strict=False)),
            point(rng.choice(FLOATS), ("a",), parts),
            Slotted(1, parts),
            Own(rng.choice(FLOATS)),
            rows,
        )
    )


@pytest.mark.parametrize("seed", range(60))
def test_random_trees_come_back_bit_for_bit(seed, tmp_path):
    rng = random.Random(seed)
    content = [tree(rng, 4) for _ in range(5)]
    assert same(through_a_file(content, tmp_path / "a.npz"), content)


def test_one_array_in_two_places_is_one_again(tmp_path):
    array, other = np.arange(3.0), np.arange(3.0)
    first, second, third = through_a_file([array, (array,), other], tmp_path / "a.npz")
    assert second[0] is first
    assert third is not first
    first[0] = 7.0
    assert third[0] == 0.0


def test_arrays_that_are_views_come_back_as_their_own(tmp_path):
    whole = np.arange(24.0).reshape(4, 6)
    back = through_a_file([whole[::2, 1:4], whole.T, whole[1]], tmp_path / "a.npz")
    for mine, its in zip([whole[::2, 1:4], whole.T, whole[1]], back, strict=True):
        np.testing.assert_array_equal(mine, its)
        assert its.base is None or its.base is not whole
    assert back[1].flags.f_contiguous, "sums over it round alike"


@dataclass
class Unlisted:
    x: float = 0.0


@pytest.mark.parametrize(
    "value",
    [Unlisted(), {1, 2}, b"raw", 1j, lambda: 1, Path("a"), np.array([None]), np.ma.array([1.0]), object, Ellipsis],
)
def test_what_is_not_plain_is_refused_when_it_is_written(value):
    with pytest.raises(ResultError, match=r"cannot be written: files hold numbers.*listed as 'classes'"):
        packed({"a": [value]}, KIND, CLASSES)


@pytest.mark.parametrize(
    "classes",
    [(int,), ("Point",), (Point, enum.Enum("Point", "A")), (lambda: 1,)],
    ids=["no dataclass", "name", "same name", "function"],
)
def test_classes_are_dataclasses_or_enumerations_of_different_names(classes):
    with pytest.raises(TypeError, match=r"must be a dataclass or an enumeration|two classes are named Point"):
        by_name(classes)


def crafted(path, tree, about=None, arrays=()):
    """A file with a tree of somebody's own."""
    about = {"format": "ngwear test", "version": 3, "ngwear": "0.2.0"} if about is None else about
    members = {"about": about, "tree": tree}
    with path.open("wb") as file:
        write(
            file, {n: np.frombuffer(json.dumps(c).encode(), dtype=np.uint8) for n, c in members.items()} | dict(arrays)
        )
    return path


CALLED = []


@dataclass
class Trap:
    x: float = field(default_factory=lambda: CALLED.append("factory"))

    def __init__(self, x=0.0):
        CALLED.append("init")

    def __setstate__(self, state):
        CALLED.append("setstate")


TREES = {
    "function": {"object": ["os.system", {"command": "touch crafted"}]},
    "class outside the table": {"object": ["Trap", {"x": 1.0}]},
    "builtin": {"object": ["eval", {"source": "1"}]},
    "enum as object": {"object": ["Colour", {"value": 1}]},
    "object as enum": {"enum": ["Point", "x"]},
    "method of an enum": {"enum": ["Colour", "__class__"]},
    "unknown tag": {"call": ["print", "x"]},
    "two tags": {"tuple": [], "dict": {}},
    "a field too many": {"object": ["Slotted", {"a": 1, "b": [], "__class__": 2}]},
    "a field too few": {"object": ["Slotted", {"a": 1}]},
    "array beyond": {"array": [0, 0, [4], "C"]},
    "array before": {"array": [0, -2, [2], "C"]},
    "array that is not there": {"array": [1, 0, [1], "C"]},
    "array of a negative shape": {"array": [0, 0, [-1], "C"]},
    "array of a huge shape": {"array": [0, 0, [2**40, 2**40], "C"]},
    "pairs with a key that is none": {"pairs": [[[1], 2]]},
    "nothing": {},
}


@pytest.mark.parametrize("name", TREES)
def test_crafted_trees_are_refused_and_nothing_is_called(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = crafted(tmp_path / "a.npz", TREES[name], arrays={"values 0": np.arange(3.0)})
    with pytest.raises(ResultError, match=r"a\.npz cannot be read as a test \(.*\); throw it away"):
        read(path, KIND, CLASSES)
    assert not CALLED
    assert [file.name for file in tmp_path.iterdir()] == ["a.npz"]


def test_nesting_without_an_end_is_refused(tmp_path):
    path = tmp_path / "a.npz"
    text = b'{"tuple":' * 100_000
    about = json.dumps({"format": "ngwear test", "version": 3, "ngwear": "0.2.0"}).encode()
    with path.open("wb") as file:
        write(file, {"about": np.frombuffer(about, np.uint8), "tree": np.frombuffer(text, np.uint8)})
    with pytest.raises(ResultError, match="cannot be read as a test"):
        read(path, KIND)


class Bomb:
    def __reduce__(self):
        return CALLED.append, ("unpickled",)


def pickled(path):
    import pickle

    path.write_bytes(pickle.dumps(Bomb()))


def object_array(path):
    np.savez(path, about=np.array([Bomb()], dtype=object), tree=np.array([Bomb()], dtype=object))


def object_values(path):
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.array([Bomb()], dtype=object), allow_pickle=True)
    crafted(path, {"array": [0, 0, [1], "C"]})
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("values 0.npy", buffer.getvalue())


def single_array(path):
    with path.open("wb") as file:
        np.save(file, np.arange(3.0))


def other_zip(path):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("about.npy", "no array")


@pytest.mark.parametrize(
    "make", [pickled, object_array, object_values, single_array, other_zip], ids=lambda f: f.__name__
)
def test_foreign_files_are_refused_and_never_unpickled(make, tmp_path):
    make(tmp_path / "a.npz")
    with pytest.raises(ResultError, match=r"a\.npz cannot be read as a test \(.*\); throw it away"):
        read(tmp_path / "a.npz", KIND, CLASSES)
    assert not CALLED


def test_a_file_cut_anywhere_or_changed_anywhere_is_refused_or_the_same(tmp_path):
    content, path, rng = [np.arange(50.0), ["text"] * 9, {"a": 1.5}], tmp_path / "a.npz", random.Random(3)
    through_a_file(content, path)
    whole = path.read_bytes()
    for _ in range(100):
        path.write_bytes(whole[: rng.randrange(len(whole))])
        with pytest.raises(ResultError, match="cannot be read as a test"):
            read(path, KIND)
    for _ in range(200):
        changed = bytearray(whole)
        changed[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        path.write_bytes(changed)
        with suppress(ResultError):
            assert same(read(path, KIND), content), "a bit that nothing reads, as a time"


@pytest.mark.parametrize(
    ("about", "told"),
    [
        (
            {"version": 2, "ngwear": "0.1.9"},
            r"a test of version 2, written by ngwear 0\.1\.9; this is .* reads version 3",
        ),
        (
            {"version": 4, "ngwear": "9.0"},
            r"a test of version 4, written by ngwear 9\.0.*throw it away, or take ngwear 9",
        ),
        ({"format": "ngwear other"}, "is not a test of ngwear: its format is 'ngwear other'; throw it away"),
        ({"format": None}, "is not a test of ngwear: its format is None"),
    ],
)
def test_other_versions_and_kinds_say_what_they_are_and_what_to_do(about, told, tmp_path):
    path = crafted(tmp_path / "a.npz", [], {"format": "ngwear test", "version": 3, "ngwear": "0.2.0"} | about)
    with pytest.raises(ResultError, match=told):
        read(path, KIND)
