"""Effects that a pin scene neglects, and whether they matter, from an estimate of its contact."""

from __future__ import annotations

import math

from ngwear.explanation import adhesion, film, heat, inertia
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.verdict import Verdict, onset
from ngwear.scene.pin_scene import Pin, PinScene

WORN, TURNS = 0.01, 1000  # share of the sheet's thickness, and turns that wear it: round numbers, stated in the verdict
WARM = 1.0  # K of flash temperature from which on the warming by all turns before may count: a tenth of heat.LIMIT


def left_out(scene: PinScene, assumed: Assumed) -> dict[str, Verdict]:
    """Verdict on each effect that no pin scene has; the contact is a disc of uniform pressure."""
    return {
        "wear": _wear(scene.pin),
        "stick-slip": Verdict(words="the pin slides steadily in one direction", matters=False),
        "heat": _heat(scene, assumed),
        "adhesion": _adhesion(scene.pin, assumed),
        "inertia": _inertia(scene, assumed),
        "fluid film": _film(scene, assumed),
    }


def _pressure(pin: Pin) -> float:
    return pin.load / (math.pi * pin.contact_radius**2)


def _wear(pin: Pin) -> Verdict:
    """By the depth of one pass in the middle of the track, 2 k p a."""
    rate = WORN * pin.thickness / (TURNS * _pressure(pin) * 2 * pin.contact_radius)
    words = f"a wear rate of {rate:.2g} mm²/N removes {WORN:.0%} of the sheet's thickness in {TURNS} turns of the pin"
    return Verdict(words=words, matters=None, numbers={"wear rate from which it counts [mm²/N]": rate})


def _heat(scene: PinScene, assumed: Assumed) -> Verdict:
    """By a disc of heat that moves over the rubber and rests on the ball; equal temperature of both (Archard)."""
    pin, speed = scene.pin, max(scene.speeds)
    law, radius = pin.friction_law, pin.contact_radius
    if law is None:
        return Verdict(words="the surface has no friction: there is no frictional heat", matters=False)

    def rise(v: float) -> float:
        flux = law.mu(0.0, v) * _pressure(pin) * v
        ball = heat.disc_rise(flux, radius, 0.0, assumed.counter_conductivity, assumed.counter_heat_capacity)
        sheet = heat.disc_rise(flux, radius, v, assumed.rubber_conductivity, assumed.rubber_heat_capacity)
        return heat.shared_rise(ball, sheet)

    found, power = max(rise(v) for v in scene.speeds), 1e-3 * law.mu(0.0, speed) * pin.load * speed
    numbers = {
        "flash temperature [K]": found,
        "speed from which the flash temperature exceeds 10 K [mm/s]": onset(rise, heat.LIMIT, low=1e-3, high=1e7),
        "Péclet number of the rubber at the fastest [-]": heat.peclet(speed, radius, assumed.rubber_diffusivity),
        "frictional power at the fastest [W]": power,
    }
    matters: bool | None = found > heat.LIMIT
    words = (
        f"estimated +{found:.2g} K of flash temperature, {'above' if matters else 'below'} the {heat.LIMIT:g} K that "
        "change stiffness and losses of rubber: mu p v on a disc that moves over the rubber and rests on the steel "
        "ball, both at the same temperature (Tian and Kennedy; Archard)"
    )
    if not matters and found > WARM:
        matters = None
        words += (
            f". But {power:.2g} W at the highest speed and the losses in the rubber heat pin and track in every turn: "
        )
        words += "this depends on the cooling, which no scene gives"
    return Verdict(words=words, matters=matters, numbers={k: v for k, v in numbers.items() if math.isfinite(v)})


def _adhesion(pin: Pin, assumed: Assumed) -> Verdict:
    pull = adhesion.point_pull_off(pin.radius, assumed.work_of_adhesion) / pin.load
    modulus = pin.material.plane_strain_modulus
    tabor = adhesion.tabor(pin.radius, modulus, assumed.work_of_adhesion, assumed.equilibrium_distance)
    much = pull > adhesion.LIMIT
    words = (
        f"clean, dry and smooth with {1e3 * assumed.work_of_adhesion:g} J/m² the pull-off force would be "
        f"{pull:.2g} of the load (Johnson, Kendall and Roberts; Tabor's number {tabor:.2g})"
    )
    words += (
        f". More than {adhesion.LIMIT:g}: it may matter if the contact is clean and dry" if much else ": negligible"
    )
    numbers = {"pull-off force over load [-]": pull, "Tabor's number [-]": tabor}
    return Verdict(words=words, matters=None if much else False, numbers=numbers)


def _inertia(scene: PinScene, assumed: Assumed) -> Verdict:
    modulus, density = scene.pin.material.shear_modulus, assumed.rubber_density
    found = inertia.mach_squared(max(scene.speeds), modulus, density)
    wave = inertia.wave_speed(modulus, density)
    matters = found > inertia.LIMIT
    words = f"rho v²/G = {found:.2g} at the highest speed, with the long-term G (limit {inertia.LIMIT:g}): "
    words += "it matters" if matters else "negligible"
    numbers = {
        "rho v²/G [-]": found,
        "speed of shear waves [m/s]": 1e-3 * wave,
        "speed from which inertia counts [mm/s]": math.sqrt(inertia.LIMIT) * wave,
    }
    return Verdict(words=words, matters=matters, numbers=numbers)


def _film(scene: PinScene, assumed: Assumed) -> Verdict:
    pin, oil, modulus = scene.pin, assumed.oil_viscosity, scene.pin.material.plane_strain_modulus

    def ratio(speed: float) -> float:
        return film.point_film(oil, speed, pin.load, pin.radius, modulus) / assumed.roughness

    slow, fast = ratio(min(scene.speeds)), ratio(max(scene.speeds))
    carries = fast >= film.MIXED
    words = (
        f"flooded with oil of {1e6 * oil:g} Pa s and {1e3 * assumed.roughness:g} µm rough, film over roughness would "
        f"be {slow:.2g} to {fast:.2g} (Hamrock and Dowson, soft contact): {film.regime(slow)} at the lowest "
        f"speed, {film.regime(fast)} at the highest. The scene does not say whether there is oil"
    )
    numbers = {
        "Hersey number eta v a / load at the fastest [-]": film.hersey(
            oil, max(scene.speeds), pin.load / pin.contact_radius
        ),
        "film over roughness at the fastest [-]": fast,
        "speed from which a film carries [mm/s]": onset(ratio, film.MIXED),
    }
    return Verdict(words=words, matters=None if carries else False, numbers=numbers)
