"""What the contacts hold of a fluid: the pressure at which it leaks, and whether it blows by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ngwear.effects.fluid_pressure import LESS, FluidPressure

# Of the fluid's pressure: how much less counts as blow-by. So exact is the contact pressure of a part that the fluid
# presses into its groove (geometries/rectangular_ring).
ERRS = 0.01


@dataclass(frozen=True)
class BlowBy:
    """A fluid that no contact holds.

    Attributes
    ----------
    inlet, edge : str
        Where it comes from, and the edge whose contact would hold it longest; without a contact the last edge.
    pressure, holds : float
        Pressure of the fluid, and the highest contact pressure on its way [MPa]; 0 without a contact.
    meets : str
        Name of the inlet that the way leads to; empty if to none.
    """

    inlet: str
    edge: str
    pressure: float
    holds: float
    meets: str


@dataclass(frozen=True)
class BarelyHeld:
    """A ridge of contact pressure that just holds a fluid, with a part of the contact behind it that would not.

    Attributes
    ----------
    inlet, edge : str
        Where the fluid comes from, and the edge with the ridge.
    pressure, ridge, behind : float
        Pressure of the fluid, highest contact pressure of the ridge, and lowest behind it [MPa].
    next_edge : str
        Edge with the contact that would hold the fluid next.
    """

    inlet: str
    edge: str
    pressure: float
    ridge: float
    behind: float
    next_edge: str


def leak_pressure(fluid: FluidPressure) -> tuple[float, str]:
    """Fluid pressure that the present contacts can seal [MPa], and the name of the edge at which it leaks first.

    A seal leaks when the fluid's pressure exceeds the contact pressure everywhere along a path (Liu, Wang, Chen & Suo,
    *Elastic leak of a seal*, Extreme Mech. Lett. 1 (2014) 54). Of the two paths from the inlet, the one with the lower
    maximum of contact pressure leaks first. The contact pressures are those of the present state; a fluid that presses
    the part against its contacts, as with an O-ring, increases them.
    """
    first = min(_ways(fluid), key=lambda way: way.holds)
    return first.holds, first.edge


def blow_by(fluid: FluidPressure) -> BlowBy | None:
    """Where no contact holds the fluid in the present state; None if all do.

    That is where the highest contact pressure on its way is below the fluid's, by more than ``ERRS``. A way that ends
    at a support, or at an inlet with the same pressure or a higher one, is closed.
    """
    for way, beyond in zip(_ways(fluid), fluid.beyond, strict=True):
        other = fluid.fluid_at(beyond)
        closed = beyond in fluid.held or (other is not None and other.pressure.Get() >= way.pressure)
        if way.holds < (1 - ERRS) * way.pressure and not closed:
            return way
    return None


def barely_held(fluid: FluidPressure) -> list[BarelyHeld]:
    """Where the fluid is held with less over its pressure than contact pressures err by (``ERRS``), on each way.

    Only where it matters: a part of the contact behind the ridge carries less than the fluid, and another one behind
    that would hold it. Without the ridge the fluid would lift the contact up to there.
    """
    pressure, highest = fluid.pressure.Get(), _highest(fluid)
    found: list[BarelyHeld] = []
    for (_, path), stop in zip(fluid.paths, fluid.stops(), strict=True):
        carried = np.where(stop & (fluid.shares[path] < 1.0), highest[path], 0.0)
        holds = np.flatnonzero(carried >= (1 - LESS) * pressure)
        if pressure <= 0 or len(holds) == 0:
            continue
        low = np.flatnonzero(carried[holds[0] :] < (1 - LESS) * pressure) + holds[0]
        beyond = holds[holds > low[0]] if len(low) else low
        ridge = carried[holds[0] : low[0]] if len(low) else carried
        if len(beyond) == 0 or ridge.max() > (1 + ERRS) * pressure:
            continue
        top, behind = holds[0] + int(ridge.argmax()), float(carried[low[0] : beyond[0]].min())
        names = fluid.names[path]
        found.append(
            BarelyHeld(fluid.name, str(names[top]), pressure, float(ridge.max()), behind, str(names[beyond[0]]))
        )
    return found


def _highest(fluid: FluidPressure) -> np.ndarray:
    """Highest contact pressure of each mesh edge, in the order of the outline [MPa]."""
    highest = np.zeros(len(fluid.names))
    for contact in fluid.contacts:
        highest[contact.positions] = np.maximum(highest[contact.positions], contact.edge_peaks())
    return highest


def _ways(fluid: FluidPressure) -> list[BlowBy]:
    """What holds the fluid on each of its two ways."""
    names, highest = fluid.names, _highest(fluid)
    found = []
    for (_, path), beyond, stop in zip(fluid.paths, fluid.beyond, fluid.stops(), strict=True):
        held = np.where(stop, highest[path], 0.0)
        at, other = path[held.argmax() if held.any() else -1], fluid.fluid_at(beyond)
        meets = "" if other is None else other.name
        found.append(BlowBy(fluid.name, str(names[at]), fluid.pressure.Get(), float(highest[at]), meets))
    return found
