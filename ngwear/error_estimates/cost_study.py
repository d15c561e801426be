"""State of a cost study: its runs, their errors, and predicted error and time of other settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ngwear.error_estimates.convergence_order import observed_order, reference_error, relative
from ngwear.error_estimates.ladder import Ladder, Measurement, Setting, with_level
from ngwear.error_estimates.pareto_front import pareto_front, power_law, product_seconds

TARGETS = (0.05, 0.01, 0.001)  # a look, a decision, a reference
SETTLED = 0.1 * min(TARGETS)  # error of the finest rung below which a finer one changes no choice


@dataclass
class Study:
    """Runs in which one parameter at a time is varied from a common base setting.

    Each parameter has a ladder: its values from coarse to fine. The first ladder is that of the mesh; the others are
    run on the mesh of ``base``. The error of a setting is the sum over its parameters of the difference from the finest
    run of the ladder and of the error of that finest run. Errors of opposite sign do not cancel in this sum.

    Attributes
    ----------
    ladders : tuple of Ladder
    main : str
        The quantity to which the target errors belong.
    base : tuple of int
        Base setting: level on each ladder.
    runs : dict
        Measurement of each setting, in the order of the runs.
    left_out : dict
        Predicted wall time of settings that were not run for lack of time [s]; nan if not known.
    """

    ladders: tuple[Ladder, ...]
    main: str
    base: Setting
    runs: dict[Setting, Measurement] = field(default_factory=dict)
    left_out: dict[Setting, float] = field(default_factory=dict)

    @property
    def own(self) -> Setting:
        """The scene's own setting."""
        return tuple(ladder.own for ladder in self.ladders)

    @property
    def spent(self) -> float:
        """Wall time of all runs, including earlier calls [s]."""
        return sum(run.wall for run in self.runs.values())

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities, the main one first."""
        names = dict.fromkeys([self.main] + [name for run in self.runs.values() if run.ok for name in run.values])
        return tuple(names)

    def levels(self, k: int) -> dict[int, Measurement]:
        """Completed runs of a ladder by level, coarse to fine."""
        found = {i: self.runs.get(with_level(self.base, k, i)) for i in range(len(self.ladders[k].values))}
        return {i: run for i, run in found.items() if run is not None and run.ok}

    def _series(self, k: int, quantity: str) -> tuple[list[float], list[float]]:
        levels = self.levels(k)
        return [self.ladders[k].values[i] for i in levels], [run.values[quantity] for run in levels.values()]

    def order(self, k: int, quantity: str) -> float | None:
        """Observed order of convergence of a quantity in a parameter; None if there is none."""
        return observed_order(*self._series(k, quantity)) if self.ladders[k].smooth else None

    def own_error(self, k: int, quantity: str) -> float:
        """Estimated relative error of a ladder's finest run; infinite with fewer than two runs."""
        values, results = self._series(k, quantity)
        found = reference_error(values, results, smooth=self.ladders[k].smooth) if values else None
        return math.inf if found is None else self.ladders[k].remaining * found

    def level_error(self, k: int, level: int, quantity: str) -> float | None:
        """Relative difference from the ladder's finest run; None if the level has not been run."""
        levels = self.levels(k)
        if level not in levels:
            return None
        return relative(levels[level].values[quantity], levels[max(levels)].values[quantity])

    def part(self, k: int, level: int, quantity: str) -> float:
        """Contribution of a parameter's value to the error; infinite if it is not known.

        It is at least that of every finer level, because a coarse level may be close to the reference by chance. A
        level finer than all runs has the error of the finest run.
        """
        levels = self.levels(k)
        if not levels or (level < max(levels) and level not in levels):
            return math.inf
        found = [self.level_error(k, i, quantity) or 0.0 for i in levels if i >= level]
        return max(found, default=0.0) + self.own_error(k, quantity)

    def predicted_error(self, setting: Setting, quantity: str) -> float:
        """Relative error of a setting as the sum over its parameters; infinite if one is not known."""
        return sum(self.part(k, i, quantity) for k, i in enumerate(setting))

    @property
    def finest(self) -> Setting:
        """Setting with the finest completed level of each ladder; that of the base if a ladder has none."""
        return tuple(max(self.levels(k), default=self.base[k]) for k in range(len(self.ladders)))

    def added(self, quantity: str) -> float:
        """Value of the base run plus the corrections by the finest run of each ladder; nan without the base run."""
        base = self.runs.get(self.base)
        if base is None or not base.ok:
            return math.nan
        value = base.values[quantity]
        return value + sum(list(self.levels(k).values())[-1].values[quantity] - value for k in range(len(self.ladders)))

    def best(self, quantity: str) -> float:
        """Value of the run at ``finest``; without that run, ``added``."""
        run = self.runs.get(self.finest)
        return run.values[quantity] if run is not None and run.ok else self.added(quantity)

    def error(self, setting: Setting, quantity: str) -> float:
        """Relative error of a run: the larger of the predicted one and the difference from ``best``."""
        predicted, best = self.predicted_error(setting, quantity), self.best(quantity)
        if math.isnan(best):
            return predicted
        return max(predicted, relative(self.runs[setting].values[quantity], best))

    def seconds(self, setting: Setting, *, wall: bool = False) -> float:
        """CPU or wall time of a setting [s]: measured, or predicted from the completed levels."""
        run = self.runs.get(setting)
        if run is not None and run.ok:
            return run.wall if wall else run.cpu
        each = [
            {i: run.wall if wall else run.cpu for i, run in self.levels(k).items()} for k in range(len(self.ladders))
        ]
        return product_seconds(self.base, each, setting)

    def next_seconds(self, k: int, level: int) -> float:
        """Predicted wall time of a level that has not been run [s]; nan without any run of the ladder."""
        ladder, levels = self.ladders[k], self.levels(k)
        base = self.runs.get(self.base)
        if not levels:
            return base.wall if base is not None and base.ok else math.nan
        last = levels[max(levels)]
        if level < max(levels):
            return levels[min(i for i in levels if i > level)].wall
        if ladder.values[level] == 0:
            return last.wall * max(1.0, ladder.most_solves / max(last.solves, 1))
        values, walls = [ladder.values[i] for i in levels], [run.wall for run in levels.values()]
        most = last.wall * max(1.0, ladder.most_solves / max(last.solves, 1)) if ladder.most_solves else math.inf
        return power_law(values, walls, ladder.values[level], ladder.cost_exponent, most)

    def settled(self, k: int) -> bool:
        """Whether no finer level is needed: the finest run, finer than the scene, has a negligible error.

        By its estimated error if there is an order, else by the last two changes of the main quantity.
        """
        levels = list(self.levels(k).items())
        if len(levels) < 3 or levels[-1][0] <= self.ladders[k].own:
            return False
        if self.order(k, self.main) is not None:
            return self.own_error(k, self.main) < SETTLED
        results = [run.values[self.main] for _, run in levels[-3:]]
        return max(relative(a, results[2]) for a in results[:2]) < SETTLED

    def front(self) -> list[Setting]:
        """Pareto front: runs that no other run beats in CPU time and error of the main quantity, the fastest first."""
        known = [s for s, run in self.runs.items() if run.ok and math.isfinite(self.error(s, self.main))]
        points = [(self.runs[s].cpu, self.error(s, self.main)) for s in known]
        return [known[i] for i in pareto_front(points)]
