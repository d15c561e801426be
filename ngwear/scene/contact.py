"""One contact: a rigid surface, the edges of the part that may touch it, and the laws of friction and wear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

from ngwear.errors import check_fields, require, typed
from ngwear.laws import FrictionLaw, WearLaw, WearRate, law_of
from ngwear.scene.checks import refuse_in_contact
from ngwear.surfaces import RigidSurface

ANY_EDGE = "*"


@dataclass(frozen=True)
class Contact:
    """A rigid surface and the edges of the part that may touch it.

    Parameters
    ----------
    name : str
    edges : sequence of str
        Names of edges of the part's outline; default: any may touch (``"*"``, which a scene replaces by all names).
        Of a part with room to move, any may touch whatever is named here.
    surface : RigidSurface
        In its final position; mounting moves it there from first touch.
    friction : FrictionLaw or float
        Coefficient of friction [-], >= 0.
    slides : bool
        Whether the surface moves along itself in the strokes, as a rod does; False for a housing.
    sticks : bool or None
        True: stick and slip, with unknowns and a history of the tractions. False: full sliding in every stroke.
        Default: ``Scene.may_stick`` decides.
    specific_wear_rate : WearRate or float
        Archard's k [mm²/N], >= 0: worn depth over nominal pressure and sliding distance.
    wear_law : WearLaw or None
        Factor on k that depends on the pressure; default Archard's law (factor 1). It holds for the surface too.
    counter_wear_rate : float
        k of the surface, which then has a worn profile [mm²/N], >= 0; only if the part wears too.
    force : float or None
        Force that presses the surface on [N, or N/mm in plane strain]; default: its position is given instead.
    refine : bool
        Whether the mesh is refined in this contact, and results hold its pressures; it always is if the contact wears,
        and all contacts are if none wears and none asks for it.

    Raises
    ------
    SceneError
        If a value is out of range, or two values contradict each other.
    """

    name: str
    _: KW_ONLY
    edges: Sequence[str] = (ANY_EDGE,)
    surface: RigidSurface
    friction: FrictionLaw | float = 0.0
    slides: bool = True
    sticks: bool | None = None
    specific_wear_rate: WearRate | float = 0.0
    wear_law: WearLaw | None = None
    counter_wear_rate: float = 0.0
    force: float | None = None
    refine: bool = False

    def __post_init__(self) -> None:
        place = f"contact '{self.name}'"
        check_fields(self, place)
        require(isinstance(self.surface, RigidSurface), f"{place}.surface", self.surface, "must be a rigid surface")
        require(bool(self.edges), f"{place}.edges", self.edges, "name at least one edge")
        if not isinstance(self.friction, FrictionLaw):
            friction = typed(f"{place}.friction", self.friction, "float")
            require(friction >= 0, f"{place}.friction", self.friction, "must be at least 0")
        if not isinstance(self.specific_wear_rate, WearRate):
            rate = typed(f"{place}.specific_wear_rate", self.specific_wear_rate, "float")
            require(rate >= 0, f"{place}.specific_wear_rate", rate, "must be at least 0 mm²/N")
        law = self.wear_law
        require(law is None or isinstance(law, WearLaw), f"{place}.wear_law", law, "must be a law of wear")
        counter = self.counter_wear_rate
        require(counter >= 0, f"{place}.counter_wear_rate", counter, "must be at least 0 mm²/N")
        require(
            self.force is None or self.force > 0, f"{place}.force", self.force, "must be greater than 0 (it presses)"
        )
        refuse_in_contact(self)

    @property
    def friction_law(self) -> FrictionLaw | None:
        """The friction law; None without friction."""
        return law_of(self.friction)

    @property
    def wear_rate(self) -> WearRate:
        """The specific wear rate as a table; a number becomes a table with one row."""
        rate = self.specific_wear_rate
        return rate if isinstance(rate, WearRate) else WearRate(distance=(0.0,), rate=(rate,))

    @property
    def wears(self) -> bool:
        """Whether the part wears in this contact."""
        return self.wear_rate.highest > 0
