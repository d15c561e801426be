"""Accuracy settings of a scene: element edges and tolerances, or one number that sets all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ngwear.errors import SceneError, check_fields, require

ORDERS = (1, 2, 3)  # of the displacement
# Lengths and tolerances were settled on the rod seal and the shaft, those by elements across on all scenes that wear by
# moved nodes (presets.py, adaptive_against_fixed.py): the list in tests/benchmarks/README.md says which.
PATCH, COARSE, MOUNTING = 0.01, 0.2, 0.03  # mm, where neither lengths nor elements across are given
STRESS_ERROR, WEAR_ERROR = 0.05, 0.02  # with lengths: the rod seal's depth errs by 0.08 and 0.59 % (``ngwear cost``)
STRESS_ACROSS, DEPTH_ACROSS = 0.2, 0.008  # stress and depth error with ALIKE elements across
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
    """Element edges [mm] and their growth [-], as in ``Accuracy``; all of them known."""

    patch: float
    coarse: float
    mounting: float
    grading: float


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Relative tolerances [-], as in ``Accuracy``; all of them known."""

    stress_error: float
    wear_error: float
    longest_jump: float
    depth_error: float


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Accuracy settings: give element edges, or ``across``, or ``error``.

    Parameters
    ----------
    patch : float or None
        Element edge in the refined contacts [mm]; default 0.01.
    coarse : float or None
        Largest element edge, far from the contacts [mm]; default 0.2.
    mounting : float or None
        Smallest element edge at the refined contacts while the part is mounted [mm]; default 0.03. The mesh is refined
        after mounting.
    grading : float or None
        Growth of the element edge with the distance from the contact [-]. Default 0.25; with ``across`` it is 0.4 for
        12 elements across, up to 0.5 for fewer and less for more. Where this is too coarse, ``stress_error`` refines.
    order : int
        Polynomial order of the displacement: 1, 2 or 3. Order 3 converges fastest for smooth solutions; at the ends of
        a contact the solution is not smooth. ``ngwear cost`` compares the orders (``error_estimates.settings``).
    stress_error : float or None
        Allowed error indicator of the stresses over the energy norm, for elements outside the contacts [-]; default
        0.05. With 1 no element is refined for its stress.
    wear_error : float or None
        Allowed relative error of the worn area in a cycle jump [-]; default 0.02. The estimate is conservative. Laws of
        friction and wear may change by five times as much in one jump (``ngwear.loop.law_changes``).
    longest_jump : float or None
        Longest cycle jump over the number of cycles in the program [-]; default five times ``wear_error``. Reason:
        where pressures change slowly, the limit on the growth of jumps acts before ``wear_error``. The error of the
        jumps would then be the same in a coarser run, and no comparison would show it. Also, each stroke of a cycle is
        solved with the predicted wear of the others; after long jumps its pressure overshoots where they end contact.
    depth_error : float or None
        Allowed relative error of the maximum depth by all wear steps together, by their embedded estimate [-]; each
        step may use its share of the program. Default 1, which limits nothing; with ``across`` it follows from it.
    folding_error : float
        Largest relative error of stress by relaxation times that are left out of the memory [-].
    parts : int
        Number of equal parts into which each stroke is divided; each is solved once. This is the time step of rubber
        with memory: the strain is constant in each part (``ngwear.loop.memory_over_cycles``).
    across : float or None
        Number of elements across a contact, mean by load, instead of lengths [-]. The run sets ``patch`` from the
        contact width at each new mesh, smaller for bumps of pressure narrower than the contact, such as lobes and the
        peak at the end of a lip's contact, and the other lengths from the size of the section.
        Tolerances that are not given follow: ``stress_error`` with the square of the element edge; ``depth_error``,
        ``wear_error`` (up to 0.05) and ``longest_jump`` in proportion to the element edge.
    error : float or None
        Allowed relative error of the maximum depth [-]; the run chooses all other settings
        (``ngwear.error_estimates.run_to_error``).
    peak_error : float or None
        Allowed relative error of the peak pressure [-]; only together with ``error``.

    Raises
    ------
    SceneError
        If a value is out of range, or two values contradict each other.
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
        """The preset with this name: "draft", "engineering" or "reference".

        Raises
        ------
        SceneError
            If there is no preset with this name.
        """
        require(name in PRESETS, "accuracy.preset", name, f"must be one of {list(PRESETS)}")
        return cls(across=PRESETS[name])

    @classmethod
    def draft(cls) -> Accuracy:
        """For a first result. README lists errors and computing times on the shipped scenes."""
        return cls.preset("draft")

    @classmethod
    def engineering(cls) -> Accuracy:
        """For design decisions."""
        return cls.preset("engineering")

    @classmethod
    def reference(cls) -> Accuracy:
        """For reference solutions."""
        return cls.preset("reference")

    def with_tolerances_of(self, other: Accuracy) -> Accuracy:
        """Take lengths and tolerances (or ``across``, or ``error``) of another; keep order, folding_error and parts.

        The grading is kept if it was given; the default is replaced by the other's default.
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
        """The same with this number of elements across and these tolerances; grading as in ``with_tolerances_of``."""
        return self.with_tolerances_of(
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
        """Element edges and grading.

        Raises
        ------
        SceneError
            If the run chooses them later, by ``across`` or ``error``.
        """
        patch, coarse, mounting, grading = self.patch, self.coarse, self.mounting, self.grading
        if patch is None or coarse is None or mounting is None or grading is None:
            raise SceneError(
                "accuracy.patch", patch, "is not known before the run: accuracy.across or accuracy.error chooses it"
            )
        return Lengths(patch=patch, coarse=coarse, mounting=mounting, grading=grading)

    @property
    def tolerances(self) -> Tolerances:
        """The tolerances.

        Raises
        ------
        SceneError
            If the run chooses them later, by ``error``.
        """
        stress, wear, jump, depth = self.stress_error, self.wear_error, self.longest_jump, self.depth_error
        if stress is None or wear is None or jump is None or depth is None:
            raise SceneError("accuracy.wear_error", wear, "is not known before the run: accuracy.error chooses it")
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
        require(self.parts >= 1, "accuracy.parts", self.parts, "must be at least 1; 1 solves each stroke as a whole")
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
        """Set a value that is not given to its default; return the value."""
        if getattr(self, name) is None:
            object.__setattr__(self, name, value)
        holds: float = getattr(self, name)
        return holds

    def _refuse_two_ways(self) -> None:
        """SceneError for settings that contradict each other, or for an error that no estimate can resolve."""
        lengths = [name for name in ("patch", "coarse", "mounting") if getattr(self, name) is not None]
        tolerances = [name for name in TOLERANCES if getattr(self, name) is not None]
        if self.across is not None:
            says = f"must lie between {LEAST_ACROSS:g} and {MOST_ACROSS:g} elements"
            require(LEAST_ACROSS <= self.across <= MOST_ACROSS, "accuracy.across", self.across, says)
            says = f"sets {lengths} too: give only one of them"
            require(not lengths, "accuracy.across", self.across, says)
        if self.error is not None:
            given = lengths + tolerances + (["across"] if self.across is not None else [])
            require(not given, "accuracy.error", self.error, f"lets the run choose {given}: give only one of them")
            require(self.error < 1, "accuracy.error", self.error, "must be below 1; 0.01 is one per cent")
            says = (
                f"is below {LEAST_ERROR:g}, the smallest error that a comparison of two meshes can show: give a larger "
                "one, or give accuracy.across and compare runs yourself"
            )
            require(self.error >= LEAST_ERROR, "accuracy.error", self.error, says)
        peak = self.peak_error
        if peak is not None:
            says = "needs accuracy.error, the allowed error of the depth: give both"
            require(self.error is not None, "accuracy.peak_error", peak, says)
            says = f"must lie between {LEAST_ERROR:g} and 1; 0.1 is ten per cent"
            require(LEAST_ERROR <= peak < 1, "accuracy.peak_error", peak, says)


def _usual_grading(across: float | None) -> float:
    """Default grading for a number of elements across; None: lengths are given."""
    return GRADING if across is None else min(STEEPEST, GRADING_ACROSS * (ALIKE / across) ** STEEPER)
