"""Wear of one solve: predicted outline, implicit depth in the solve, and the outline after it."""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ngwear.effects.contact_profile import ContactProfile
from ngwear.errors import GeometryError, MeshError
from ngwear.geometry.outline import Outline, polygon_area, polygon_moment
from ngwear.geometry.recession import recede, receded, refuse_worn_through, without_tongues
from ngwear.loop.carried_error import with_more_worn
from ngwear.loop.remeshing import remesh
from ngwear.loop.state import LastWear, State
from ngwear.scene.contact import Contact
from ngwear.wear.archard import worn_share
from ngwear.wear.backward_differences import error_over_difference, share_of_last
from ngwear.wear.sliding_distance import Strokes
from ngwear.wear.within_edges import evened

Array = NDArray[np.float64]
log = logging.getLogger(__name__)

# Beyond, a contact has only begun to spread, or the mesh shows; checked by ``tests/stability`` (wearing.py).
CALM = 0.1  # error of a step over what it wears, up to which the next one may rely on it
AREA_GATE = 0.05  # of a step's worn area: how far an outline healed or without tongues may miss it


@dataclass
class WearStep:
    """Wear of the strokes for which one solve stands: ``begin``, solve, ``apply``.

    Implicit wear of second order in the step. The outline is predicted: it moves by the wear at the mean pressure of
    the last step, so that the rubber has about the thickness and position of the end of the step. The depth in the
    solve is measured from the predicted outline: ``w_1 - w_0 = kappa (a q_0 + (1 - a) p_1)`` as in
    ``wear.backward_differences``. The outline loses areas, each point by the pressures times the lengths at which they
    act, ``kappa (a q_0 l_0 + (1 - a) p_1 l_1)``: of second order where the points come closer, as at a sharp lip, and
    the sum is that of the loads. Where friction may stick, and after a step whose error is large or not known, it is
    backward Euler without a predicted outline: first order, and reliable where a contact begins to spread.

    Attributes
    ----------
    outline : Outline
        Outline before the wear.
    end_weight : array, shape (contacts,)
        Weight of the pressure at the end of the step, 1 - a [-].
    last_depth : array, shape (contacts, n)
        Depth at the points of the outline by the mean load of the last step, ``kappa a q_0 l_0`` over the length
        halfway [mm].
    predicted_depth : array, shape (contacts, n)
        Depth between the outline and the predicted outline [mm].
    later_depth : array, shape (n,)
        Depth that later strokes of the step will wear, if the nodes cannot move to the predicted outline [mm]; the
        solve leaves it as a gap.
    """

    state: State
    index: int
    sliding: Strokes
    outline: Outline
    end_weight: Array
    last_depth: Array
    predicted_depth: Array
    later_depth: Array

    @classmethod
    def begin(cls, state: State, index: int, sliding: Strokes, *, later: dict[int, Strokes] | None = None) -> WearStep:
        """Predict the outline of a stroke of the cycle, and set the wear of its contacts for the next solve.

        ``later`` are the strokes of other kinds in this step that come after this solve, before the last stroke of this
        kind.
        """
        scene, phase, outline = state.stage.scene, state.phases[index], state.contour
        n, count = len(outline), len(scene.contacts)
        none = np.zeros((count, n))
        wear_step = cls(state, index, sliding, outline, np.ones(count), none, none, np.zeros(n))
        ways = wear_step.ways
        if scene.wear.scheme == "implicit" and phase.worn is not None and phase.error <= CALM:
            share = np.array([share_of_last(*pair) for pair in zip(ways, phase.worn.ways, strict=True)])
            depth = wear_step._depth_at_mean_pressure(index, sliding)
            share *= depth.any(axis=1)
            wear_step.end_weight = 1.0 - share
            wear_step._predict_outline(depth, later or {})
            lengths = [of.widths(scene.worn_edges) for of in (outline, wear_step.halfway)]
            wear_step.last_depth = share[:, None] * depth * lengths[0] / lengths[1]
        implicit = scene.wear.scheme == "implicit"
        for spec, weight in zip(scene.contacts, wear_step.end_weight, strict=True):
            contact = state.stage.contacts[spec.name]
            contact.compliance.Set(weight * sliding.worn_depth(spec.wear_rate) if implicit else 0.0)
        for name, known in wear_step.known_depth.items():
            state.stage.contacts[name].set_worn(known)
        return wear_step

    @property
    def known_depth(self) -> dict[str, Array]:
        """Depth that each wearing contact wears in the solve whatever its pressure, from the predicted outline [mm]."""
        depth = self.last_depth - self.predicted_depth + self.later_depth
        return {spec.name: depth[k] for k, spec in enumerate(self.state.stage.scene.contacts) if spec.wears}

    @property
    def halfway(self) -> Outline:
        """Outline midway between the outline and the predicted one; there, worn area is depth times length."""
        return self.outline.moved(0.5 * (self.state.contour.points - self.outline.points))

    @property
    def ways(self) -> Array:
        """Equivalent sliding distance of each contact, ``int k ds / max k`` [mm]."""
        return self._ways(self.sliding)

    def _depth_at_mean_pressure(self, kind: int, sliding: Strokes) -> Array:
        """Depth at the outline points by the mean load of the last step of a kind of stroke [mm], each contact.

        Zero where friction may stick: a place that has slipped may stick now.
        """
        stage, worn = self.state.stage, self.state.phases[kind].worn
        if worn is None:
            return np.zeros_like(self.last_depth)
        slides = np.array([not stage.contacts[c.name].slips_in_part for c in stage.scene.contacts])
        return (slides * self._ways(sliding))[:, None] * worn.mean / self.outline.widths(stage.scene.worn_edges)

    def _ways(self, sliding: Strokes) -> Array:
        return np.array([sliding.worn_distance(c.wear_rate) for c in self.state.stage.scene.contacts])

    def _predict_outline(self, depth: Array, later: dict[int, Strokes]) -> None:
        scene, later_depth = self.state.stage.scene, np.zeros(len(self.outline))
        for kind, sliding in later.items():
            if self.state.phases[kind].error <= CALM:
                later_depth = later_depth + self._depth_at_mean_pressure(kind, sliding).sum(axis=0)
        whole = depth.sum(axis=0) + later_depth
        try:
            predicted = recede(self.outline, whole * self.outline.widths(scene.worn_edges), scene.worn_edges)
            if len(predicted) != len(self.outline):
                raise GeometryError("the outline needs other points")
            self.state.stage.body.move_to(predicted)
        except (GeometryError, MeshError) as error:
            log.info("%s: the step is done without a predicted outline", error)
            self.later_depth = later_depth
            return
        moved = np.linalg.norm(predicted.points - self.outline.points, axis=1)
        self.predicted_depth = depth * np.divide(moved, whole, out=np.zeros_like(whole), where=whole > 0)

    def store_rates(self) -> None:
        """Store the wear rate at the present pressures, for the error of the first step; wears nothing.

        Not done if friction may stick: the slip is not known yet.
        """
        scene, phase = self.state.stage.scene, self.state.phases[self.index]
        if self.state.stage.has_stick_slip:
            return
        none = np.zeros_like(self.last_depth)
        end = none.copy()
        for k, spec in enumerate(scene.contacts):
            if spec.wears:
                profile, rate = self._rate(spec, {})
                end[k] = worn_share(self.outline, profile, rate * profile.weight)
        width = self.outline.widths(scene.worn_edges)
        phase.worn = LastWear(end=end, mean=none, lengths=np.stack([width, width]), ways=np.zeros(len(none)))

    def _rate(self, spec: Contact, shares: dict[str, Any]) -> tuple[ContactProfile, Array]:
        """A contact's profile, and worn depth over sliding distance at its nodes by the present pressures [-].

        Explicit steps use lumped nodal pressures; consistent ones are unstable at shorter steps.
        """
        stage = self.state.stage
        contact = stage.contacts[spec.name]
        profile = contact.profile()
        if stage.scene.wear.scheme == "explicit":
            profile = profile.straight()
        rate = spec.wear_rate.highest * shares.get(spec.name, 1.0) * profile.load / profile.weight
        rate *= contact.wear_factor(profile.pressure)
        return profile, rate / contact.at_nodes(stage.elasticity.volume_ratio())

    def _carried(self, error: Array, end: Array, shares: dict[str, Any]) -> Array:
        """What is left, at the end of the step, of a depth error at the outline's points [mm].

        Where the depth is too large, the contacts wear less in the step. ``end`` are the wear rates at its end.
        """
        if not error.any():
            return error
        state, left = self.state, error.copy()
        width = self.halfway.widths(state.stage.scene.worn_edges)
        with with_more_worn(state.stage, self.known_depth, error) as found:
            for k, spec in enumerate(state.stage.scene.contacts):
                if found and spec.wears:
                    profile, rate = self._rate(spec, shares)
                    there = worn_share(state.contour, profile, rate * profile.weight)
                    left += self.ways[k] * (there - end[k]) / width
        return left

    def _book_depths(self, worn: Array, error: Array, end: Array, shares: dict[str, Any]) -> None:
        """Add depth and error of a step at the points of the outline to those of the run [mm].

        With ``wear.step = "jump"`` a step of one cycle has no error: only jumps count. The ledger adds the increase of
        the maximum depth over the points of this step, because the points of a new mesh may miss the deepest place.
        """
        state, ledger = self.state, self.state.ledger
        if state.stage.scene.wear.step == "jump" and self.sliding.repeats <= 1:
            error = np.zeros_like(error)
        last, before = np.zeros((2, len(worn))) if state.depths is None else state.depths
        carried = self._carried(before, end, shares)
        off = self._carried(before + error, end, shares) if error.any() else carried
        depth = last + worn
        state.depths = np.stack([depth, off])
        without = float((depth - off).max())
        ledger.depth += float(depth.max() - last.max())
        ledger.depth_error += float(depth.max() - without) - float(last.max() - (last - before).max())
        ledger.step_error += float((depth - carried).max()) - without

    def apply(self) -> bool:
        """Remove the worn area from the outline; return whether its error is known.

        The error of the area is the difference of the depth from that by the trapezoidal rule at the nodes of the mesh,
        times their lengths, summed over the outline in absolute value; the shape between the nodes does not depend on
        the step. The error of the depth at a point is the estimate of ``wear.backward_differences`` with its sign, and
        what contacts have left of the errors of the steps before.

        Raises
        ------
        GeometryError
            If the outline had to be healed and the removed area differs too much from the worn area.
        MeshError
            If the nodes cannot move any further and ``Wear.remesh`` is ``"never"``, or a new mesh fails.
        """
        state, outline, phase = self.state, self.outline, self.state.phases[self.index]
        last = phase.worn
        stage, scene = state.stage, state.stage.scene
        halfway = self.halfway
        width = halfway.widths(scene.worn_edges)
        shares = {}
        if stage.has_stick_slip:
            from ngwear.loop.slip_over_cycles import slip_per_cycle

            shares = slip_per_cycle(scene.program.cycle, state.phases, self.index, self.sliding.repeats) or {}
        if state.counters:
            from ngwear.loop import counter_surface

            state.counters = counter_surface.worn(stage, state.counters, self.index, self.sliding, shares)
        share, off, err = np.zeros((3, len(outline)))
        end, mean, ways = np.zeros_like(self.last_depth), np.zeros_like(self.last_depth), self.ways
        lengths = np.stack([state.contour.widths(scene.worn_edges), width])
        for k, spec in enumerate(scene.contacts):
            if not spec.wears or ways[k] == 0:
                continue
            profile, rate = self._rate(spec, shares)
            end[k] = worn_share(state.contour, profile, rate * profile.weight)
            area = self.end_weight[k] * ways[k] * end[k]
            if last is not None:
                carried = (1.0 - self.end_weight[k]) * last.mean[k]
                area += ways[k] * carried
                now, before = end[k] / lengths[0], last.end[k] / last.lengths[0]
                depth = self.end_weight[k] * now + carried / last.lengths[1]
                difference = profile.between_nodes(ways[k] * (depth - 0.5 * (before + now))) * width
                off += difference
                err += difference * error_over_difference(ways[k], last.ways[k] if self.end_weight[k] < 1.0 else 0.0)
            mean[k] = area / ways[k]
            share += evened(halfway, profile, area)
        known, error = last is not None, float(np.abs(off).sum())
        phase.error = error / float(share.sum()) if known and share.sum() > 0 else math.inf
        if known:
            state.ledger.area_error += error
        self._book_depths(share / width, err / width, end, shares)
        phase.worn = LastWear(end=end, mean=mean, lengths=lengths, ways=ways)
        if scene.deactivation is not None:
            from ngwear.geometry.element_body import elements
            from ngwear.loop import lost_elements

            points = receded(outline, share, scene.worn_edges, elements(stage.body).now.inward())
            state.ledger.worn += float(share.sum())
            state.ledger.removed += outline.area - polygon_area(points)
            state.ledger.moment += polygon_moment(outline.points) - polygon_moment(points)
            lost_elements.move_surface(state, outline, points)
            return known
        new = recede(outline, share, scene.worn_edges)
        removed, worn = outline.area - new.area, float(share.sum())
        state.ledger.worn += worn
        if abs(removed - worn) > AREA_GATE * worn:
            raise GeometryError(
                f"the outline lost {removed:.4g} mm², but the law wears {worn:.4g} mm²: its repair removed too much"
            )
        state.ledger.removed += removed
        state.ledger.moment += polygon_moment(outline.points) - polygon_moment(new.points)
        _follow(state, outline, new)
        return known


def _follow(state: State, outline: Outline, worn: Outline) -> None:
    """Move the mesh to the worn outline; remesh if that fails, unless the scene forbids it.

    Tongues that the mesher cannot fill are taken off: they tear off before they wear off. The ledger shows it. They may
    have a share (``AREA_GATE``) of the area that the step wears.
    """
    body, why = state.stage.body, "the outline needs other points"
    if len(worn) == len(outline):
        try:
            body.move_to(worn)
            return
        except MeshError as error:
            why = str(error)
    if state.stage.scene.wear.remesh == "never":
        deepest = np.linalg.norm(outline.points - body.base.points, axis=1).max()
        raise MeshError(
            f"the top layer of elements is used up at a depth of {deepest:.4g} mm: {why}; allow remeshing "
            "by wear.remesh = 'limit' or 'due', or use larger elements (accuracy.patch)"
        )
    refuse_worn_through(worn)
    log.info("%s: a new mesh is needed", why)
    try:
        remesh(state, worn)
    except MeshError as error:
        blunt = without_tongues(worn, state.stage.scene.worn_edges)
        if blunt is worn or worn.area - blunt.area > AREA_GATE * (outline.area - worn.area):
            raise
        log.info("%s: tongues of the outline are taken off", error)
        state.ledger.removed += worn.area - blunt.area
        state.ledger.moment += polygon_moment(worn.points) - polygon_moment(blunt.points)
        remesh(state, blunt)
