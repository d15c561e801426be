"""What a pin on a plate leaves out, and whether that matters, from a guess of its contact."""

from __future__ import annotations

import math

from ngwear.explanation import adhesion, film, heat, inertia
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.verdict import Verdict, onset
from ngwear.scene.pin_scene import Pin, PinScene

WORN, TURNS = 0.01, 1000  # share of the sheet's thickness, and turns that wear it: round numbers, stated in the verdict
WARM = 1.0  # K of flash temperature from which on the warming by all turns before may count: a tenth of heat.LIMIT


def left_out(scene: PinScene, assumed: Assumed) -> dict[str, Verdict]:
    """Verdict on each effect that no pin scene has, with the contact a disc of uniform pressure."""
    return {
        "wear": _wear(scene.pin),
        "stick-slip": Verdict(words="the pin slides steadily and never turns round", matters=False),
        "heat": _heat(scene, assumed),
        "adhesion": _adhesion(scene.pin, assumed),
        "inertia": _inertia(scene, assumed),
        "fluid film": _film(scene, assumed),
    }


def _pressure(pin: Pin) -> float:
    return pin.load / (math.pi * pin.contact_radius**2)


def _wear(pin: Pin) -> Verdict:
    """The depth of a pass is k p 2 a in the track's middle."""
    rate = WORN * pin.thickness / (TURNS * _pressure(pin) * 2 * pin.contact_radius)
    words = f"a wear rate of {rate:.2g} mm²/N takes {WORN:.0%} of the sheet's thickness in {TURNS} turns of the pin"
    return Verdict(words=words, matters=None, numbers={"wear rate from which it counts [mm²/N]": rate})


def _heat(scene: PinScene, assumed: Assumed) -> Verdict:
    """The disc moves over the rubber and stands on the ball; both get equally hot (Archard)."""
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
        "shift rubber's stiffness and losses: mu p v on a disc that moves over the rubber and stands on the steel "
        "ball, both equally hot (Tian and Kennedy; Archard)"
    )
    if not matters and found > WARM:
        matters = None
        words += f". But {power:.2g} W at the fastest and the rubber's own losses warm pin and track turn by turn: "
        words += "what cools them decides, and no scene tells that"
    return Verdict(words=words, matters=matters, numbers={k: v for k, v in numbers.items() if math.isfinite(v)})


def _adhesion(pin: Pin, assumed: Assumed) -> Verdict:
    pull = adhesion.point_pull_off(pin.radius, assumed.work_of_adhesion) / pin.load
    modulus = pin.material.plane_strain_modulus
    tabor = adhesion.tabor(pin.radius, modulus, assumed.work_of_adhesion, assumed.equilibrium_distance)
    much = pull > adhesion.LIMIT
    words = (
        f"clean, dry and smooth with {1e3 * assumed.work_of_adhesion:g} J/m² the ball would withstand a pull of "
        f"{pull:.2g} of its load (Johnson, Kendall and Roberts; Tabor's number {tabor:.2g})"
    )
    words += f". More than {adhesion.LIMIT:g}: it may matter if it is as clean as that" if much else ": negligible"
    numbers = {"pull-off force over load [-]": pull, "Tabor's number [-]": tabor}
    return Verdict(words=words, matters=None if much else False, numbers=numbers)


def _inertia(scene: PinScene, assumed: Assumed) -> Verdict:
    modulus, density = scene.pin.material.shear_modulus, assumed.rubber_density
    found = inertia.mach_squared(max(scene.speeds), modulus, density)
    wave = inertia.wave_speed(modulus, density)
    matters = found > inertia.LIMIT
    words = f"rho v²/G = {found:.2g} at the fastest, with the long-term G; it counts from {inertia.LIMIT:g} on: "
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
        f"be {slow:.2g} to {fast:.2g} (Hamrock and Dowson, soft contact): {film.regime(slow)} at the slowest, "
        f"{film.regime(fast)} at the fastest. Whether there is oil the scene does not tell"
    )
    numbers = {
        "Hersey number eta v a / load at the fastest [-]": film.hersey(
            oil, max(scene.speeds), pin.load / pin.contact_radius
        ),
        "film over roughness at the fastest [-]": fast,
        "speed from which a film carries [mm/s]": onset(ratio, film.MIXED),
    }
    return Verdict(words=words, matters=None if carries else False, numbers=numbers)
