"""Fluid pressure that reaches from the sealed side to the first point in contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ngsolve as ng
import numpy as np

from ngwear.effects.base import Unknowns
from ngwear.effects.contact import OutlineContact
from ngwear.effects.edge_pressure import EdgePressure
from ngwear.errors import SceneError

CENTRE = 2 / 5  # of the way in contact: how far from its inner end a square root of the way has its centre
# Half of a thousandth, the least error that a run may state; settled on the rod seal (``verify rod_seal``).
STAYS = 5e-4  # of what the contacts carry: a change of the fluid's load with which the front stands
SWINGS, LEAST = 2, 0.1  # updates with whole steps; least share of the way between two values, later
# Of the fluid's pressure: how much less a contact may carry and still hold it. A worn lip carries hardly more than the
# fluid, and a few elements across it err by some per cent. Settled on a U-cup (geometries/u_cup, reference).
LESS = 0.05


class FluidPressure(EdgePressure):
    """Follower traction ``-chi p n`` on the wetted part of named edges: the fluid from one inlet.

    chi is 1 from the middle of the inlet edges (where a surface touches that: of their longest piece without contact),
    in both directions along the outline, up to the first mesh edge in contact, and 0 beyond that one; on it, chi is the
    share of its length outside the contact (``free_of_contact``). Treating such an edge as dry would move the front by
    half an edge on average; with coarse edges the load would change by some per cent. A contact that carries less than
    the fluid's pressure (by more than ``LESS``) is lifted off its surface: the fluid passes it, and stays behind it
    until its pressure is zero, also if the contact closes again. A fluid that no contact holds ends at the highest
    contact pressure.

    chi is fixed in a solve and updated after it, until the change of load is below ``STAYS``; a front that swings
    between two edges comes to rest between them. If the fluid reaches the end of the named edges without a contact,
    ``leaks`` is True: the seal leaks. Where it meets the fluid from another inlet without a contact between them, the
    higher pressure acts on all edges between the two.

    Parameters
    ----------
    edges : sequence of str
        Edges that the fluid may reach; they must be one piece of the outline with the inlet among them.
    inlet : sequence of str
        Edges where the fluid comes in.
    contacts : sequence of OutlineContact
        Contacts that can stop the fluid.
    name : str
        Name of the inlet.
    held : sequence of str
        Edges that are held in both directions, as if bonded: no fluid passes them.

    Attributes
    ----------
    others : sequence of FluidPressure
        The fluids from the other inlets; none at first.
    traps : bool
        Whether pockets keep the fluid's pressure (``TrappedFluid``), False at first: then it does not stay behind a
        contact when its pressure falls.
    holding : float
        Share of the fluid's pressure that a contact must carry to hold it; ``1 - LESS`` at first.

    paths : list of tuple of int and array
        The two ways from the inlet: the direction along the outline, 1 or -1, and the mesh edges.
    beyond : list of str
        Edge of the outline at which each way ends.

    Raises
    ------
    SceneError
        If the inlet is not among the edges.
    """

    def __init__(
        self,
        edges: Sequence[str],
        inlet: Sequence[str],
        contacts: Sequence[OutlineContact],
        *,
        name: str = "fluid",
        held: Sequence[str] = (),
    ) -> None:
        super().__init__(edges)
        self.inlet, self.contacts = tuple(inlet), tuple(contacts)
        self.name, self.held = name, tuple(held)
        self.others: tuple[FluidPressure, ...] = ()
        self.traps, self._last, self.holding = False, 0.0, 1 - LESS
        if not self.inlet or not set(self.inlet) <= set(self.edges):
            raise SceneError("fluid.inlet", list(self.inlet), f"must name some of the fluid's edges {list(self.edges)}")
        self.pressure = ng.Parameter(0.0)
        self.loads = {f"{name} pressure [MPa]": self.pressure}
        self.leaks, self._moves = False, 0
        self._before, self._change = np.empty(0), np.empty(0)

    def nominal(self) -> Any:
        return self.pressure * self.field

    def add_to(self, form: ng.BilinearForm, unknowns: Unknowns) -> None:
        super().add_to(form, unknowns)
        self._order_path()
        self.refresh()

    def _order_path(self) -> None:
        """Order the mesh edges that the fluid may reach outwards from the inlet's middle, once in each direction."""
        self._inlet = inlet = np.isin(self.names, self.inlet)
        m = len(self.names)
        self._passed, self._reached = [0, 0], [0, 0]  # edges of each way
        self._drained = [False, False]
        whole = bool(inlet.all())
        piece = [0 if whole else int(np.flatnonzero(inlet & ~np.roll(inlet, 1))[0])]
        while inlet[(piece[-1] + 1) % m] and len(piece) < m:
            piece.append((piece[-1] + 1) % m)
        self._piece = np.array(piece)
        self._begin_in(self._piece)

    def _begin_in(self, piece: np.ndarray) -> None:
        """Begin both ways in the middle of a piece of the inlet."""
        ways, names, m = np.cumsum(self._lengths[piece]), self.names, len(self.names)
        reach = np.isin(names, self.edges)
        self.paths, self.beyond = [], []
        for step in (1, -1):
            path = [int(piece[np.searchsorted(ways, 0.5 * ways[-1])])]
            while reach[(after := (path[-1] + step) % m)] and len(path) <= m and not self.fluid_at(names[after]):
                path.append(after)
            self.paths.append((step, np.array(path)))
            self.beyond.append(str(names[after]))

    def _begin_in_the_open(self, touching: np.ndarray) -> None:
        """Begin both ways in the longest piece of the inlet without contact, if where they begin is in contact."""
        opened = ~touching[self._piece]
        if opened.all() or not opened.any() or not touching[self.paths[0][1][0]]:
            return
        pieces = np.split(self._piece, np.flatnonzero(np.diff(opened)) + 1)
        places, last = self.passed, self._last
        self._begin_in(max((p for p in pieces if not touching[p[0]]), key=lambda p: float(self._lengths[p].sum())))
        self.passed, self._last = places, last

    def fluid_at(self, edge: str) -> FluidPressure | None:
        """The fluid from another inlet that has this edge."""
        return next((other for other in self.others if edge in other.inlet), None)

    def refresh(self, *, solved: bool = False) -> bool:
        """Update the front; True if the change of load is above ``STAYS``.

        Otherwise the front stays where it was, so that the state remains an equilibrium. Only in a ``solved`` state the
        fluid passes contacts: those of a guess say nothing of what they hold.
        """
        touching, outside, carried = self._contact()
        self._begin_in_the_open(touching)
        stops = self.stops()
        share = np.where(self._inlet, 1.0, 0.0)
        self.leaks = False
        falls = self.pressure.Get() < self._last if self.traps else self.pressure.Get() == 0.0
        self._last = self.pressure.Get()
        if falls:
            self._passed, self._drained = [0, 0], [False, False]
        elif solved:
            self._pass(touching, stops)
        for k, (step, path) in enumerate(self.paths):
            stop = np.flatnonzero(stops[k])
            self.leaks |= len(stop) == 0
            stop = stop[stop >= self._passed[k]]
            reached = int(stop[0]) if len(stop) else len(path)
            dry = np.cumprod(self._inlet[path]).sum()  # edges of the inlet's half
            share[path[reached:dry]] = 0.0
            share[path[:reached]] = 1.0
            if not len(stop) and self._yields(self.fluid_at(self.beyond[k])):
                share[path] = np.where(self._inlet[path], 1.0, 0.0)
            self._reached[k] = reached if self.pressure.Get() > 0 else 0
            if len(stop) and stop[0] > 0:
                share[path[stop[0]]] = outside[path[stop[0]], 0 if step == 1 else 1]
        pressure = abs(self.pressure.Get())
        moved = pressure * float(self._lengths @ np.abs(self.shares - share)) > STAYS * carried
        if solved:
            self._moves = self._moves + 1 if moved else 0
        if moved or not solved:
            now = self.shares
            change = share - now
            if self._moves > SWINGS:
                share = now + self._between(now, change)
            self._before, self._change = now, change
            self.on_edges = share
        return moved

    def stops(self) -> list[np.ndarray]:
        """Mesh edges of each way whose contact can stop the fluid.

        A surface that touches the inlet's edges and no others of the way, such as a wall beside which the fluid comes
        in, stops it only if no other one does.
        """
        found = []
        for _, path in self.paths:
            inside, touching = self._inlet[path], np.zeros(len(path), dtype=bool)
            beyond = touching.copy()
            for contact in self.contacts:
                mine = self._touched(contact)[path]
                touching |= mine
                if (mine & ~inside).any():
                    beyond |= mine
            found.append(beyond if beyond.any() else touching)
        return found

    def _touched(self, contact: OutlineContact) -> np.ndarray:
        """Mask of the mesh edges that a contact's surface touches, in the order of the outline."""
        touched = np.zeros(len(self._inlet), dtype=bool)
        touched[contact.positions[contact.touching()]] = True
        return touched

    def on_both_sides(self) -> list[OutlineContact]:
        """Contacts that touch the inlet's edges alone, and have the fluid on both sides of all their zones."""
        found, wet = [], self.shares >= 1.0
        for contact in self.contacts:
            mine = self._touched(contact)
            ends = (np.roll(mine, 1) | np.roll(mine, -1)) & ~mine
            if mine.any() and self._inlet[mine].all() and wet[ends].all():
                found.append(contact)
        return found

    def _between(self, now: np.ndarray, change: np.ndarray) -> np.ndarray:
        """The change of chi, where the front swings one that ends between the last two values.

        The changes at these two are interpolated to zero, so that the front comes to rest there.
        """
        swings = change * self._change < 0
        part = np.divide(change, change - self._change, out=np.zeros_like(change), where=swings)
        return np.where(swings, np.clip(part, LEAST, 1 - LEAST) * (self._before - now), change)

    def _yields(self, other: FluidPressure | None) -> bool:
        """Whether the fluid from another inlet, which this one meets, has the higher pressure."""
        return other is not None and (other.pressure.Get(), other.name) > (self.pressure.Get(), self.name)

    def _pass(self, touching: np.ndarray, stops: list[np.ndarray]) -> None:
        """Let the fluid into contacts that it lifts: the next edges of ``_passed`` are those that hold it.

        A contact that closes in front of a gap that the fluid fills may drain it once, as while a load step settles;
        then no more, or the front would go to and fro.

        An edge holds it if the surroundings press it, or the next one, as hard as the fluid would: at the contact's end
        the pressure jumps from zero to the fluid's within a mesh edge, which carries less of it. On an edge that the
        fluid has wetted and that still touches, both press. Where none holds it, the fluid ends at the one that is
        pressed hardest.
        """
        bears = self._bears()
        for k, (_, path) in enumerate(self.paths):
            stop = np.flatnonzero(stops[k])
            stop = stop[stop >= self._passed[k]]
            if len(stop) == 0:
                continue
            filled = np.flatnonzero(~touching[path[: self._reached[k]]])
            if len(filled) and filled[-1] > stop[0] and not self._drained[k]:
                self._drained[k] = True
            elif len(filled) and filled[-1] > stop[0]:
                self._passed[k] = int(filled[-1]) + 1
                stop = stop[stop >= self._passed[k]]
                if len(stop) == 0:
                    continue
            last = self._held_at(bears[path], stop, self.holding)
            if last > stop[0]:
                self._passed[k] = last

    def _bears(self) -> np.ndarray:
        """What presses each mesh edge, contact or fluid [MPa]."""
        bears = sum((fluid.pressure.Get() * fluid.shares for fluid in self.others), self.pressure.Get() * self.shares)
        for contact in self.contacts:
            bears[contact.positions] = np.maximum(bears[contact.positions], contact.edge_peaks())
        return np.asarray(bears)

    def _held_at(self, bears: np.ndarray, stop: np.ndarray, holding: float) -> int:
        """Which of the edges ``stop`` of a way holds the fluid, if it takes ``holding`` of its pressure."""
        most = np.maximum(bears, np.append(bears[1:], 0.0))[stop]
        holds = stop[most >= holding * self.pressure.Get()]
        return int(holds[0]) if len(holds) else int(stop[most.argmax()])

    def comes_further(self, holding: float) -> bool:
        """Whether the fluid would come further into a contact, in the present state, if holding it took more.

        ``holding`` is the share of the fluid's pressure that a contact would have to carry.
        """
        bears = self._bears()
        for (_, path), stops, passed in zip(self.paths, self.stops(), self._passed, strict=True):
            stop = np.flatnonzero(stops)
            stop = stop[stop >= passed]
            if len(stop) and self._held_at(bears[path], stop, holding) > stop[0]:
                return self.pressure.Get() > 0
        return False

    @property
    def passed_lengths(self) -> np.ndarray:
        """Length of the mesh edges in contact that the fluid has passed, on each way, shape (2,) [mm]."""
        length = np.where(self._contact()[0], self._lengths, 0.0)
        return np.array([length[path[: self._passed[k]]].sum() for k, (_, path) in enumerate(self.paths)])

    @property
    def passed(self) -> np.ndarray:
        """Reference places up to which the fluid has lifted contacts, one a way; nan: none; shape (2, 2) [mm].

        Where it has lifted all of a way's contacts, the place is that of the last mesh edge.
        """
        places = np.full((2, 2), np.nan)
        for k, (_, path) in enumerate(self.paths):
            if self._passed[k] > 0:
                places[k] = self._middles[path[min(self._passed[k], len(path) - 1)]]
        return places

    @passed.setter
    def passed(self, places: np.ndarray) -> None:
        # A stroke begins: nothing of the last one but these places counts, so that a resumed run goes the same way.
        self._reached, self._drained, self._moves = [0, 0], [False, False], 0
        self._last = self.pressure.Get()
        for k, (_, path) in enumerate(self.paths):
            known = bool(np.isfinite(places[k]).all())
            apart = np.linalg.norm(self._middles[path] - places[k], axis=1) if known else np.zeros(1)
            self._passed[k] = int(apart.argmin())

    def _contact(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Mesh edges with contact pressure, the share of each edge's length without it, and the total contact load.

        Of shapes (m,) and (m, 2): the contact ending towards the edge's first node, and towards its second; [N/mm].
        """
        m, carried = len(self._inlet), 0.0
        touching, outside = np.zeros(m, dtype=bool), np.zeros((m, 2))
        for contact in self.contacts:
            ends = contact.touching()
            pressure = contact.end_pressures()[ends]
            touching[contact.positions[ends]] = True
            carried += float(self._lengths[contact.positions[ends]] @ pressure.mean(axis=1))
            outside[contact.positions[ends]] = free_of_contact(pressure)
        return touching, outside, carried

    def fronts(self) -> np.ndarray:
        """Outline parameters at which the fluid meets a contact in the present state; none on a path without one."""
        first = [(step, path[stop][:1]) for (step, path), stop in zip(self.paths, self.stops(), strict=True)]
        return np.concatenate([self._body.outline.t[edge, 0 if step == 1 else 1] for step, edge in first])

    @property
    def shares(self) -> np.ndarray:
        """Value of chi on each mesh edge, in the order of the outline, shape (m,) [-]."""
        return self.on_edges


def free_of_contact(pressure: np.ndarray) -> np.ndarray:
    """Share of each mesh edge outside the contact, if the contact ends within it, from the edge pressures, shape (m,
    2).

    The result is of the same shape: of contacts that end towards the first node, and towards the second. A pressure
    begins as the square root of the distance from the contact's end, so that over the way L in contact its centre lies
    at 2/5 L from the edge's inner end: L follows from the linear pressure that the mesh edge carries. 0 where it
    carries none.
    """
    first, second = pressure.T
    whole = first + second
    thirds = np.stack([2 * first + second, first + 2 * second], axis=1)
    centre = np.divide(thirds, 3 * whole[:, None], out=np.full_like(thirds, CENTRE), where=whole[:, None] > 0)
    return np.clip(1 - centre / CENTRE, 0.0, 1.0)
