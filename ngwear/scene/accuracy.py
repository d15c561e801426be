"""Knobs that trade time for error: lengths and tolerances, or one number for all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ngwear.errors import SceneError, check_fields, require

ORDERS = (1, 2, 3)  # of the displacement
# Lengths and tolerances were settled on the rod seal and the shaft, those by elements across on all scenes that wear by
# moved nodes (presets.py, adaptive_against_fixed.py): the list in tests/benchmarks/README.md says which.
PATCH, COARSE, MOUNTING = 0.01, 0.2, 0.03  # mm, where neither lengths nor elements across are given
STRESS_ERROR, WEAR_ERROR = 0.05, 0.02  # with lengths: the rod seal's depth errs by 0.08 and 0.59 % (``ngwear cost``)
STRESS_ACROSS, DEPTH_ACROSS = 0.2, 0.006  # stress and depth error with ALIKE elements across
LOOSEST = 0.05  # wear error: beyond, with few elements across, steps err by more than the mesh, and are hard to solve
LONGEST_JUMP = 5.0  # times the wear error: a tenth of the program with 0.02
ALIKE = 12.0  # elements across at which the wear error is that of lengths: the preset for decisions
GRADING = 0.25  # of lengths: stresses then ask for little more
GRADING_ACROSS, STEEPER, STEEPEST = 0.4, 0.4, 0.5  # with ALIKE elements across; power of its growth with fewer; most
TOLERANCES = ("stress_error", "wear_error", "longest_jump", "depth_error")
LEAST_ACROSS, MOST_ACROSS = 0.5, 200.0  # below, nothing resolves a contact; above, a run takes hours
LEAST_ERROR = 1e-3  # what two meshes differ by where nodes happen to fall: ``verify error_estimates``
PRESETS = {"draft": 6.0, "engineering": 12.0, "reference": 24.0}  # elements across: tests/benchmarks/presets.py


@dataclass(frozen=True, kw_only=True)
class Lengths:
    """What a mesh is made by: element edges [mm] and their growth [-], each as of ``Accuracy``."""

    patch: float
    coarse: float
    mounting: float
    grading: float


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """What a run on one mesh after the other may err by [-], each as of ``Accuracy``."""

    stress_error: float
    wear_error: float
    longest_jump: float
    depth_error: float


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Knobs that trade time for error: lengths, or ``across``, or ``error``.

    Parameters
    ----------
    patch : float or None
        Element edge in the followed contacts [mm]; 0.01 unless given.
    coarse : float or None
        Element edge far away [mm]; 0.2 unless given.
    mounting : float or None
        Element edge at the followed edges' finest while the part is mounted [mm]; the mesh is refined after. 0.03
        unless given.
    grading : float or None
        Growth of the element edge with the distance from the patch [-]; 0.25 unless given; with ``across`` 0.4 for 12,
        up to 0.5 for fewer and less for more: the stresses' error asks for what is missing.
    order : int
        Polynomial order of the displacement: 1, 2 or 3, of which 3 converges fastest where all is smooth; the contact's
        edges are not. ``ngwear cost`` compares them on a scene's own elements: see ``error_estimates.settings``.
    stress_error : float or None
        Error indicator of the stresses over the energy norm, up to which elements outside the contacts stay
        coarse [-], all of them with 1; 0.05 unless given.
    wear_error : float or None
        Relative error of worn area that the cycle jump aims at; the estimate errs on the safe side. Laws of friction
        and wear may change by five times as much in a jump (``ngwear.loop.law_changes``). 0.02 unless given.
    longest_jump : float or None
        Longest cycle jump over the program's cycles [-]; five times ``wear_error`` unless given. Where pressures change
        slowly, jumps end with their growth from step to step before ``wear_error`` holds them back, and what they err
        by would be the same in a coarser run: no comparison would show it. And a stroke of the cycle is solved with
        what the others are expected to wear: after long jumps its pressure overshoots where they end the contact.
    depth_error : float or None
        What all wear steps may err by of the greatest depth, as they tell of themselves [-]: each by its share of the
        program. 1, which limits nothing, unless given, or with ``across``.
    folding_error : float
        Largest relative error of stress that arms of the memory may cause by being folded away [-].
    parts : int
        Into how many equal parts each stroke is divided, each with a solve of its own: the time step of rubber with
        memory, whose strain is taken to stand still in each (``cycle_memory``).
    across : float or None
        Elements across the contacts, on the average by load, instead of lengths: the run chooses ``patch`` with each
        new mesh, for each zone of a contact by its own width, and by the section's size the other lengths. Tolerances
        that are not given go along: the stresses' with the square of the element edge, the depth's, the wear's, up to
        0.05, and the longest jump with the edge.
    error : float or None
        Relative error of the greatest depth that the run shall state [-]; the run chooses all else
        (``ngwear.error_estimates.run_to_error``).
    peak_error : float or None
        Relative error of the peak pressure that it shall state as well [-]; with ``error`` only.
    """

    patch: float | None = None
    coarse: float | None = None
    mounting: float | None = None
    grading: float | None = None
    order: int = 2
    stress_error: float | None = None
    wear_error: float | None = None
    longest_jump: float | None = None
    depth_error: float | None = None
    folding_error: float = 1e-3  # the least error that a run may state
    parts: int = 1
    across: float | None = None
    error: float | None = None
    peak_error: float | None = None

    @classmethod
    def preset(cls, name: str) -> Accuracy:
        """The preset of a name.

        Raises
        ------
        SceneError
            If there is none.
        """
        require(name in PRESETS, "accuracy.preset", name, f"must be one of {list(PRESETS)}")
        return cls(across=PRESETS[name])

    @classmethod
    def draft(cls) -> Accuracy:
        """For a first look: tests/benchmarks/README.md has errors and seconds measured on the shipped scenes."""
        return cls.preset("draft")

    @classmethod
    def engineering(cls) -> Accuracy:
        """For decisions."""
        return cls.preset("engineering")

    @classmethod
    def reference(cls) -> Accuracy:
        """For what others are measured by."""
        return cls.preset("reference")

    def given(self, other: Accuracy) -> Accuracy:
        """The other's lengths and tolerances, or what stands for them, with this one's order, folding, parts, grading.

        A grading that is as it is for this one's elements across, becomes as it is for the other's.
        """
        grading = other.grading if self.grading in (None, _usual_grading(self.across)) else self.grading
        return replace(other, grading=grading, order=self.order, folding_error=self.folding_error, parts=self.parts)

    def with_across(
        self,
        across: float,
        *,
        stress_error: float | None = None,
        wear_error: float | None = None,
        longest_jump: float | None = None,
        depth_error: float | None = None,
    ) -> Accuracy:
        """So many elements across instead, with these tolerances; the grading goes along as in ``given``."""
        return self.given(
            Accuracy(
                across=across,
                stress_error=stress_error,
                wear_error=wear_error,
                longest_jump=longest_jump,
                depth_error=depth_error,
            )
        )

    @property
    def lengths(self) -> Lengths:
        """Lengths and grading.

        Raises
        ------
        SceneError
            If a run is yet to choose them: by ``across``, or to meet an ``error``.
        """
        patch, coarse, mounting, grading = self.patch, self.coarse, self.mounting, self.grading
        if patch is None or coarse is None or mounting is None or grading is None:
            raise SceneError("accuracy.patch", patch, "is chosen while the scene runs, by accuracy.across or .error")
        return Lengths(patch=patch, coarse=coarse, mounting=mounting, grading=grading)

    @property
    def tolerances(self) -> Tolerances:
        """The tolerances.

        Raises
        ------
        SceneError
            If runs are yet to choose them, to meet an ``error``.
        """
        stress, wear, jump, depth = self.stress_error, self.wear_error, self.longest_jump, self.depth_error
        if stress is None or wear is None or jump is None or depth is None:
            raise SceneError("accuracy.wear_error", wear, "is chosen while the scene runs, to meet accuracy.error")
        return Tolerances(stress_error=stress, wear_error=wear, longest_jump=jump, depth_error=depth)

    def __post_init__(self) -> None:
        check_fields(self, "accuracy")
        self._refuse_two_ways()
        if self.error is None:
            self._default("grading", _usual_grading(self.across))
        usable = self.grading is None or 0 < self.grading <= 1
        require(usable, "accuracy.grading", self.grading, "must lie between 0 and 1")
        require(self.order in ORDERS, "accuracy.order", self.order, f"must be one of {list(ORDERS)}")
        require(
            0 <= self.folding_error < 1, "accuracy.folding_error", self.folding_error, "must be at least 0, below 1"
        )
        require(self.parts >= 1, "accuracy.parts", self.parts, "must be at least 1: the stroke in one piece")
        if self.error is not None:
            return
        finer = 1.0 if self.across is None else ALIKE / self.across
        stress = self._default(
            "stress_error", STRESS_ERROR if self.across is None else min(1.0, STRESS_ACROSS * finer**2)
        )
        depth = self._default("depth_error", 1.0 if self.across is None else min(1.0, DEPTH_ACROSS * finer))
        wear = self._default("wear_error", min(LOOSEST, WEAR_ERROR * finer))
        jump = self._default("longest_jump", min(1.0, LONGEST_JUMP * wear))
        require(0 < stress <= 1, "accuracy.stress_error", stress, "must lie between 0 and 1")
        require(0 < wear < 1, "accuracy.wear_error", wear, "must lie between 0 and 1")
        require(0 < jump <= 1, "accuracy.longest_jump", jump, "must lie between 0 and 1")
        require(0 < depth <= 1, "accuracy.depth_error", depth, "must lie between 0 and 1")
        if self.across is not None:
            return
        patch = self._default("patch", PATCH)
        coarse, mounting = self._default("coarse", COARSE), self._default("mounting", MOUNTING)
        require(patch > 0, "accuracy.patch", patch, "must be greater than 0 mm")
        require(coarse >= patch, "accuracy.coarse", coarse, "must be at least the patch size")
        require(mounting >= patch, "accuracy.mounting", mounting, "must be at least the patch size")

    def _default(self, name: str, value: float) -> float:
        """Set what is not given; return what holds."""
        if getattr(self, name) is None:
            object.__setattr__(self, name, value)
        holds: float = getattr(self, name)
        return holds

    def _refuse_two_ways(self) -> None:
        """SceneError for an accuracy that is said twice, or that no run can show."""
        lengths = [name for name in ("patch", "coarse", "mounting") if getattr(self, name) is not None]
        tolerances = [name for name in TOLERANCES if getattr(self, name) is not None]
        if self.across is not None:
            says = f"must lie between {LEAST_ACROSS:g} and {MOST_ACROSS:g} elements"
            require(LEAST_ACROSS <= self.across <= MOST_ACROSS, "accuracy.across", self.across, says)
            says = f"gives what {lengths} gives too: leave either out"
            require(not lengths, "accuracy.across", self.across, says)
        if self.error is not None:
            given = lengths + tolerances + (["across"] if self.across is not None else [])
            require(not given, "accuracy.error", self.error, f"lets the run choose {given}: leave either out")
            require(self.error < 1, "accuracy.error", self.error, "must be below 1; 0.01 is one per cent")
            says = (
                f"is less than an estimate from two meshes can see, {LEAST_ERROR:g}: ask for that at least, or give "
                "accuracy.across and judge by runs of your own"
            )
            require(self.error >= LEAST_ERROR, "accuracy.error", self.error, says)
        peak = self.peak_error
        if peak is not None:
            says = "goes with accuracy.error, that of the depth: give it, too"
            require(self.error is not None, "accuracy.peak_error", peak, says)
            says = f"must lie between {LEAST_ERROR:g} and 1; 0.1 is ten per cent"
            require(LEAST_ERROR <= peak < 1, "accuracy.peak_error", peak, says)


def _usual_grading(across: float | None) -> float:
    """Of so many elements across; of lengths if None."""
    return GRADING if across is None else min(STEEPEST, GRADING_ACROSS * (ALIKE / across) ** STEEPER)
