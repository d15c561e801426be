"""A scene on a meshed section: its terms, their loads and the equilibrium problem."""

from __future__ import annotations

from typing import TYPE_CHECKING

import ngsolve as ng
import numpy as np
from numpy.typing import NDArray

from ngwear.effects.base import DISPLACEMENT
from ngwear.effects.contact import OutlineContact
from ngwear.effects.elasticity import Elasticity
from ngwear.equilibrium.problem import FixedEdges, Problem
from ngwear.errors import SceneError
from ngwear.fields.kinematics import Axisymmetric, PlaneStrain
from ngwear.geometry.meshed_section import MeshedSection
from ngwear.laws import FrictionLaw
from ngwear.scene.boundary import TRAPPED, Fluid
from ngwear.scene.contact import Contact
from ngwear.scene.holding import free_directions
from ngwear.scene.program import Stroke
from ngwear.scene.scene import Scene
from ngwear.surfaces import WornProfile

if TYPE_CHECKING:  # modules of effects that the scene does not have are not imported
    from ngwear.effects.blow_by import BarelyHeld, BlowBy
    from ngwear.effects.fluid_pressure import FluidPressure
    from ngwear.effects.friction import Friction, FullSliding
    from ngwear.effects.stick_slip import StickSlip
    from ngwear.effects.stroke_memory import StrokeMemory
    from ngwear.effects.trapped_fluid import TrappedFluid
    from ngwear.fields.background_mesh import Background

Array = NDArray[np.float64]


class Stage:
    """The effects of a scene on one mesh; only effects that the scene has are built.

    Attributes
    ----------
    contacts : dict of str to OutlineContact
    frictions : dict of str to Friction
        All contacts with friction; ``sticking`` are those with stick and slip, ``sliding`` those in full sliding.
    fluids : dict of str to FluidPressure
        The fluid from each inlet; empty without any.
    floats : tuple of int
        Components of the displacement in which nothing holds the part (``ngwear.scene.holding``).
    memory : StrokeMemory or None
    problem : Problem
    friction_shares : dict of str to tuple of float and str
        Share of the friction in full sliding that acts in a stroke, and what more of it does to the part; a stroke
        that is not named has all of it (``ngwear.loop.bearable_friction``).

    ``background`` is the mesh on which the viscoelastic memory is stored; None, as during mounting: no memory.
    """

    def __init__(
        self,
        scene: Scene,
        body: MeshedSection,
        background: Background | None = None,
        friction_shares: dict[str, tuple[float, str]] | None = None,
    ) -> None:
        self.scene, self.body, self.friction_shares = scene, body, dict(friction_shares or {})
        rubber = scene.rubber
        modulus = rubber.shear_modulus
        self.elasticity = Elasticity(rubber, order=scene.accuracy.order)
        self.contacts = {
            spec.name: OutlineContact(
                spec.name,
                spec.edges,
                spec.surface,
                modulus=modulus,
                order=scene.accuracy.order,
                force_controlled=spec.force is not None,
                wears=spec.wears,
                counter=WornProfile.of(spec.surface, scene.accuracy.lengths.patch)
                if spec.counter_wear_rate > 0
                else None,
            )
            for spec in scene.contacts
        }
        self.frictions: dict[str, Friction] = {}
        self.sticking: dict[str, StickSlip] = {}
        self.sliding: dict[str, FullSliding] = {}
        for spec in scene.contacts:
            law = spec.friction_law
            if law is not None:
                self.frictions[spec.name] = self._friction(spec, law)
            if spec.wears and spec.wear_law is not None:
                from ngwear.effects.pressure_wear import PressureWear

                mu = self.frictions[spec.name].coefficient if spec.name in self.frictions else None
                wear = PressureWear(spec.wear_law, modulus=modulus, coefficient=mu)
                self.contacts[spec.name].pressure_wear = wear
        self.fluids = {} if scene.fluid is None else self._fluids(scene.fluid)
        terms = [self.elasticity, *self.contacts.values(), *self.frictions.values(), *self.fluids.values()]
        self.trapped: TrappedFluid | None = None
        if scene.fluid is not None and scene.fluid.pockets == TRAPPED:
            from ngwear.effects.trapped_fluid import TrappedFluid

            fluids = tuple(self.fluids.values())
            self.trapped = TrappedFluid(scene.fluid.edges, fluids, tuple(self.contacts.values()))
            terms.append(self.trapped)
        self.floats = free_directions(scene)
        if self.floats:
            from ngwear.effects.rigid_motion import RigidMotion

            terms.append(RigidMotion(self.floats, tuple(self.contacts.values()), modulus=modulus))
        self.memory: StrokeMemory | None = None
        if background is not None and (arms := scene.arms) is not None:
            from ngwear.effects.stroke_memory import StrokeMemory

            self.memory = StrokeMemory(rubber, arms, background)
            terms.append(self.memory)
        self.problem = Problem(
            body,
            Axisymmetric() if scene.axisymmetric else PlaneStrain(),
            terms,
            supports=[FixedEdges(s.edges, s.x, s.y) for s in scene.supports],
            order=scene.accuracy.order,
        )

    def _friction(self, spec: Contact, law: FrictionLaw) -> Friction:
        """Build the friction term of a contact."""
        scene, contact = self.scene, self.contacts[spec.name]
        speed = scene.program.cycle[0].speed
        if scene.may_stick(spec):
            from ngwear.effects.stick_slip import StickSlip

            self.sticking[spec.name] = StickSlip(contact, law, speed=speed)
            return self.sticking[spec.name]
        from ngwear.effects.friction import FullSliding

        self.sliding[spec.name] = FullSliding(contact, law, speed=speed, stepped=scene.deactivation is not None)
        return self.sliding[spec.name]

    def _fluids(self, spec: Fluid) -> dict[str, FluidPressure]:
        """Build the fluid pressure from each inlet."""
        from ngwear.effects.fluid_pressure import FluidPressure

        contacts = tuple(self.contacts.values())
        held = [edge for support in self.scene.supports for edge in support.edges if support.x and support.y]
        fluids = {
            name: FluidPressure(spec.edges, edges, contacts, name=name, held=held)
            for name, edges in spec.inlets.items()
        }
        for fluid in fluids.values():
            fluid.traps = spec.pockets == TRAPPED
            fluid.others = tuple(other for other in fluids.values() if other is not fluid)
        return fluids

    def stroke_loads(self, stroke: Stroke) -> dict[str, float]:
        """Loads of a stroke: position or force of each surface, direction of sliding, fluid pressure."""
        loads: dict[str, float] = {}
        for spec in self.scene.contacts:
            contact = self.contacts[spec.name]
            loads |= dict.fromkeys(contact.loads, 0.0 if spec.force is None else spec.force)
            if spec.name in self.frictions:
                friction = self.frictions[spec.name]
                share, _ = self.friction_shares.get(stroke.name, (1.0, ""))
                way = stroke.travel if friction.remembers else share
                loads |= dict.fromkeys(friction.loads, stroke.direction * way if spec.slides else 0.0)
        for name, fluid in self.fluids.items():
            loads |= dict.fromkeys(fluid.loads, stroke.pressure_at(name))
        return loads

    def leak_pressure(self) -> tuple[float, str] | None:
        """Pressure that the contacts can seal [MPa], and the edge that leaks first; None if the scene does not ask."""
        if not self.leaking:
            return None
        from ngwear.effects.blow_by import leak_pressure

        return min(leak_pressure(fluid) for fluid in self.leaking)

    def blow_by(self) -> tuple[BlowBy, ...]:
        """The fluids that no contact holds in the present state."""
        if not self.fluids:
            return ()
        from ngwear.effects.blow_by import blow_by

        return tuple(blown for fluid in self.fluids.values() if (blown := blow_by(fluid)) is not None)

    def barely_held(self) -> tuple[BarelyHeld, ...]:
        """The fluids that contacts hardly hold in the present state."""
        if not self.fluids:
            return ()
        from ngwear.effects.blow_by import barely_held

        return tuple(ridge for fluid in self.fluids.values() for ridge in barely_held(fluid))

    def fluid_may_come_further(self) -> bool:
        """Whether a fluid would come further into a contact, within what contact pressures err by."""
        if not self.fluids:
            return False
        from ngwear.effects.blow_by import ERRS

        return any(fluid.comes_further(1 + ERRS) for fluid in self.fluids.values())

    @property
    def leaking(self) -> list[FluidPressure]:
        """The fluids if the scene asks for the leak pressure, else none."""
        spec = self.scene.fluid
        return list(self.fluids.values()) if spec is not None and spec.leak_pressure else []

    def fluid_passed(self) -> Array | None:
        """Places up to which the fluids have lifted contacts in the present state, for ``let_fluid_pass``; None: none.

        Of shape (inlets, 2, 2): inlet, way, coordinates.
        """
        if not self.fluids:
            return None
        places = np.array([fluid.passed for fluid in self.fluids.values()])
        return places if np.isfinite(places).any() else None

    def let_fluid_pass(self, places: Array | None, *, after: Stroke | None = None) -> None:
        """Set the places up to which the fluids have lifted contacts, before a solve.

        In a stroke ``after`` one without pressure the contacts have closed again: none is lifted yet.
        """
        for k, (name, fluid) in enumerate(self.fluids.items()):
            closed = after is not None and after.pressure_at(name) == 0.0
            fluid.passed = np.full((2, 2), np.nan) if places is None or closed else places.reshape(-1, 2, 2)[k]

    def fluid_left(self) -> Array | None:
        """What the fluids leave on the outline in the present state, for ``leave_fluid``; None if pockets hold none."""
        return None if self.trapped is None else self.trapped.leaves

    def leave_fluid(self, left: Array | None) -> None:
        """Begin a stroke with what the fluids have left in the last one."""
        if self.trapped is not None and left is not None:
            self.trapped.leave(left)

    @property
    def has_stick_slip(self) -> bool:
        """Whether a contact has stick and slip: then a stroke depends on the end of the previous one."""
        return bool(self.sticking)

    def begin(self, vector: Array) -> None:
        """Start a stroke from the state in which another ended: slip is measured from there."""
        state = self.problem.state.vec.FV().NumPy()
        keep = state.copy()
        state[:] = vector
        for friction in self.sticking.values():
            friction.begin()
        state[:] = keep

    def begin_unloaded(self, vector: Array) -> None:
        """Start from the state of the unloaded part, as if nothing had been solved: no slip, no fluid has passed."""
        self.problem.set_loads(self.mounted_loads())
        self.begin(vector)
        self.let_fluid_pass(None)
        self.leave_fluid(np.empty((0, 3)))

    def shares(self, stroke: Stroke) -> dict[str, Array]:
        """Slip over travel of the nodes in the stroke just solved [-], for each contact with stick and slip."""
        ways = {name: friction.slid() for name, friction in self.sticking.items()}
        return {name: self.contacts[name].edges_to_nodes(way) / stroke.travel for name, way in ways.items()}

    def set_shares(self, shares: dict[str, Array] | None) -> None:
        """Set slip over travel for the wear of the next solve; 1 if it is not known."""
        for name, contact in self.contacts.items():
            if contact.share is not None:
                contact.set_share(1.0 if shares is None else shares[name])

    def stretched_guess(self) -> bool:
        """Stretch an axisymmetric part at constant volume until it clears its shafts; False if no shaft overlaps it.

        ``r' = sqrt(r^2 + (a + d)^2 - a^2)`` for an overlap d at the radius a: the exact displacement of an
        incompressible ring, so that this guess has no volumetric strain. The equilibrium from there takes a fifth of
        the iterations of mounting by interference from first touch.
        """
        growth = 0.0
        if not self.scene.axisymmetric:
            return False
        for spec in self.scene.contacts:
            if spec.force is None and spec.surface.approach[1] > 0.5:
                overlap = self._overlap(spec)
                radius = float(self.body.contour.points[self._clearance(spec)[1], 1])
                growth = max(growth, (radius + overlap) ** 2 - radius**2)
        if growth == 0.0:
            return False
        self.problem.fields[DISPLACEMENT].Set(ng.CF((0, (ng.y**2 + growth) ** 0.5 - ng.y)))
        return True

    def first_touch(self) -> dict[str, float]:
        """Loads before mounting: surfaces that overlap the part are moved back until they just touch it."""
        loads: dict[str, float] = {}
        for spec in self.scene.contacts:
            contact = self.contacts[spec.name]
            overlap = self._overlap(spec)
            if spec.force is None:
                loads |= dict.fromkeys(contact.loads, -overlap)
            else:
                loads |= dict.fromkeys(contact.loads, 0.0)
                self.problem.fields[contact.travel_name].vec[:] = self._travel_to_touch(spec)
        return self.mounted_loads() | loads

    def mounted_loads(self) -> dict[str, float]:
        """Loads of the mounted part before the first stroke: no fluid pressure, no sliding.

        Full sliding has no state at rest: such a surface is mounted sliding, except if the rubber may tear, or if
        nothing holds the part, which friction would drag along.
        """
        loads = self.stroke_loads(self.scene.program.cycle[0])
        for friction in self.frictions.values():
            if friction.remembers or self.scene.deactivation is not None or self.floats:
                loads |= dict.fromkeys(friction.loads, 0.0)
        for fluid in self.fluids.values():
            loads |= dict.fromkeys(fluid.loads, 0.0)
        return loads

    def _clearance(self, spec: Contact) -> tuple[float, int]:
        """Smallest gap over the contact's edges [mm], and the number of the outline point with it."""
        contour = self.body.contour
        mine = contour.on(spec.edges)
        touching = mine | np.roll(mine, 1)
        gap = spec.surface.gap(*contour.points[touching].T)
        worst = int(np.argmin(gap))
        return float(gap[worst]), int(np.flatnonzero(touching)[worst])

    def _travel_to_touch(self, spec: Contact) -> float:
        """Travel along the approach at which a surface under force overlaps the part slightly [mm]."""
        ax, ay = spec.surface.approach
        contour = self.body.contour
        mine = contour.on(spec.edges)
        x, y = contour.points[mine | np.roll(mine, 1)].T

        def smallest(travel: float) -> float:
            return float(spec.surface.gap(x - travel * ax, y - travel * ay).min())

        # Enough overlap to press on the mesh edges beside the nearest point.
        here = spec.surface.gap(x, y)
        first = int(here.argmin())
        beside = here[max(first - 1, 0) : first + 2]
        bite = min(float(beside.max() - here[first]), 0.1 * self.scene.accuracy.lengths.mounting)  # crushes none
        bite += 1e-6 * float(contour.lengths.min())
        travel, reach = 0.0, 10.0 * float(np.ptp(contour.points, axis=0).max())
        for _ in range(500):  # the gap is a distance: a step of this length does not pass the place
            off = smallest(travel) + bite
            travel += off
            if abs(off) < 1e-3 * bite:
                return travel
            if abs(travel) > reach:
                break
        raise SceneError(
            f"contact '{spec.name}'.surface", spec.surface, "does not meet its edges along its direction of approach"
        )

    def _overlap(self, spec: Contact) -> float:
        """Distance by which the surface must move back along its approach to clear the part [mm]."""
        contour = self.body.contour
        mine = contour.on(spec.edges)
        x, y = contour.points[mine | np.roll(mine, 1)].T
        ax, ay = spec.surface.approach
        low, high = 0.0, float(np.ptp(contour.points, axis=0).max())

        def smallest(retreat: float) -> float:
            return float(spec.surface.gap(x + retreat * ax, y + retreat * ay).min())

        if smallest(0.0) >= 0:
            return 0.0
        if smallest(high) < 0:
            raise SceneError(
                f"contact '{spec.name}'.surface",
                spec.surface,
                "cannot be moved back along its approach until it clears the part",
            )
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if smallest(middle) >= 0 else (middle, high)
        return high

    def margins(self) -> dict[str, float]:
        """Stability margin of each contact in full sliding [-] (``Ripples.margin``); below 0, waves grow along it."""
        return {name: friction.margin() for name, friction in self.sliding.items()}

    def forces(self) -> dict[str, Array]:
        """Resultants on the part in the present state, (x, y) [N, or N/mm in plane strain].

        Contact pressure and friction of each contact, fluid pressure, and in axisymmetry the radial resultant of the
        hoop tension. At equilibrium their sum is the force on the supports, with opposite sign.
        """
        found = {}
        for name, contact in self.contacts.items():
            found[name] = contact.force()
            if name in self.frictions:
                found[f"{name} friction"] = self.frictions[name].force()
        found |= {name: fluid.force() for name, fluid in self.fluids.items()}
        if self.trapped is not None:
            found["trapped fluid"] = self.trapped.force()
        if self.scene.axisymmetric:
            found["hoop"] = np.array([0.0, -self.problem.hoop_force()])
        return found
