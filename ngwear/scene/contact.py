"""A rigid surface, the edges that may touch it, and the laws between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

from ngwear.errors import check_fields, require, typed
from ngwear.laws import FrictionLaw, WearLaw, WearRate, law_of
from ngwear.scene.checks import refuse_in_contact
from ngwear.surfaces import RigidSurface


@dataclass(frozen=True)
class Contact:
    """A rigid surface and the edges that may touch it.

    Parameters
    ----------
    name : str
    edges : sequence of str
        Of the part's outline.
    surface : RigidSurface
        In its final place; while mounting it comes in from first touch.
    friction : FrictionLaw or float
        Coefficient of friction [-], >= 0.
    slides : bool
        Whether the surface moves along itself in the strokes, as a rod does; a housing stands still.
    sticks : bool or None
        Whether friction may stick, with unknowns and a history of its own, or all of the contact slides in every
        stroke; left to ``Scene.may_stick`` unless given.
    specific_wear_rate : WearRate or float
        Archard's k [mm²/N], >= 0: depth per nominal pressure and sliding distance.
    wear_law : WearLaw or None
        What the wear makes of the pressure, times that k; Archard's law unless given. The surface wears by it too.
    counter_wear_rate : float
        That of the surface, which keeps a worn profile of its own [mm²/N], >= 0; only where the part wears too.
    force : float or None
        Press the surface on with this force [N, or N/mm in plane strain] instead of by its place.
    refine : bool
        Whether the mesh shall follow this contact; wearing contacts always are followed.
    """

    name: str
    _: KW_ONLY
    edges: Sequence[str]
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
        """The law of friction; None without any."""
        return law_of(self.friction)

    @property
    def wear_rate(self) -> WearRate:
        """The specific wear rate as a table, of one row for a number."""
        rate = self.specific_wear_rate
        return rate if isinstance(rate, WearRate) else WearRate(distance=(0.0,), rate=(rate,))

    @property
    def wears(self) -> bool:
        """Whether there is any wear."""
        return self.wear_rate.highest > 0
