"""Effects that a wear scene neglects, and whether they matter, from its contact pressures."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from ngwear.explanation import adhesion, film, heat, inertia, relaxation
from ngwear.explanation.assumptions import Assumed
from ngwear.explanation.contact_pressures import Pressing, Strip
from ngwear.explanation.surface_temperature import warming
from ngwear.explanation.verdict import Verdict, onset
from ngwear.loop.law_changes import friction_range
from ngwear.materials.library import FILLED_ARMS, FILLED_LONG_TERM, FILLED_TIMES
from ngwear.scene.scene import Scene

SHARE = 0.1  # of a load or a width: from which on it counts; stated in every verdict
RELAXED = 0.05  # of the stiffness: what is left of relaxation once it counts as over
UNSAID = "the strokes have no speed"


def left_out(scene: Scene, pressing: Pressing, *, has_stick_slip: bool, assumed: Assumed) -> dict[str, Verdict]:
    """Verdict on each effect that the scene does not have; ``has_stick_slip``: whether it has stick and slip."""
    found: dict[str, Callable[[], Verdict]] = {}
    touching = [s for s in pressing.strips if s.contact.slides] or list(pressing.strips)
    rubbing = [s for s in touching if s.contact.slides and s.contact.friction_law is not None]
    hidden = pressing.missing or "no surface touches the part on the mounting mesh"

    def of(strips: list[Strip], judge: Callable[[Scene, list[Strip], Assumed], Verdict]) -> Verdict:
        if strips:
            return judge(scene, strips, assumed)
        return Verdict(words=f"the contact pressure is not known: {hidden}", matters=None)

    frictions = [c for c in scene.contacts if c.friction_law is not None]
    sliding = [c for c in frictions if c.slides]
    if scene.part.prony is None:
        found["viscosity"] = lambda: _viscosity(scene)
    if not has_stick_slip:
        found["stick-slip"] = lambda: _stick_slip(scene)
    found["heat"] = lambda: of(rubbing, _heat) if sliding else _NO_HEAT
    found["adhesion"] = lambda: of(touching, _adhesion)
    found["inertia"] = lambda: _inertia(scene, assumed)
    found["fluid film"] = lambda: of(touching, _film)
    if not frictions:
        found["friction"] = lambda: of(touching, _friction)
    if not scene.worn_edges:
        found["wear"] = lambda: of(touching, _wear)
    if scene.fluid is None:
        found["fluid pressure"] = lambda: of(touching, _fluid)
    return {name: judge() for name, judge in found.items()}


_NO_HEAT = Verdict(words="no sliding surface has friction: there is no frictional heat", matters=False)


def _main(strips: list[Strip]) -> Strip:
    return max(strips, key=lambda strip: strip.peak)


def _where(strip: Strip) -> str:
    x, y = strip.place
    return f"'{strip.contact.name}' at ({x:.3g}, {y:.3g}) mm, {strip.stroke.name} stroke"


def _finite(numbers: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in numbers.items() if math.isfinite(value)}


def _viscosity(scene: Scene) -> Verdict:
    """By Deborah's number, relaxation time over stroke duration, of the library's filled rubber."""
    ratios = [modulus / FILLED_LONG_TERM for modulus in FILLED_ARMS]
    settled = relaxation.relaxed_after(ratios, FILLED_TIMES, RELAXED)
    travel = min(stroke.travel for stroke in scene.program.cycle)
    shortest = min(stroke.duration for stroke in scene.program.cycle)
    numbers = {"speed below which the library's filled rubber has relaxed [mm/s]": travel / settled}
    unknown = "the material has no relaxation time tau for Deborah's number tau / D with the stroke duration D"
    needed = (
        f"it relaxes to within {RELAXED:.0%} in {settled:.3g} s, in strokes slower than {travel / settled:.3g} mm/s. "
        "Use moduli measured at the speed of the part, or give relaxation times ([material.prony])"
    )
    if math.isinf(shortest):
        words = f"{unknown}, and {UNSAID}. The library's filled rubber as an example: {needed}"
        return Verdict(words=words, matters=None, numbers=numbers)
    ratio = relaxation.stiffness(ratios, FILLED_TIMES, shortest)
    numbers |= {"shortest stroke D [s]": shortest, "G(D) / G_inf of the library's filled rubber [-]": ratio}
    words = (
        f"{unknown}. The library's filled rubber as an example: after D = {shortest:.3g} s it is {ratio:.3g} times as "
        f"stiff as in the long term; {needed}"
    )
    return Verdict(words=words, matters=None, numbers=numbers)


def _stick_slip(scene: Scene) -> Verdict:
    frictions = [c for c in scene.contacts if c.friction_law is not None]
    if not frictions:
        return Verdict(words="no contact has friction", matters=False)
    slip = max(scene.elastic_slip(c) for c in frictions)
    shortest = scene.program.shortest_way
    turns = len({math.copysign(1.0, stroke.direction) for stroke in scene.program.cycle}) > 1
    numbers = {"elastic slip at most over shortest stroke [-]": slip / shortest}
    if not turns:
        return Verdict(words="the direction of sliding never changes, so that the whole contact slides", matters=False)
    matters = slip > shortest
    words = f"the shortest stroke is {shortest:.3g} mm, and the contact slides after at most {slip:.2g} mm"
    words += ": the scene forbids sticking (sticks = false) although the contact would stick" if matters else ""
    return Verdict(words=words, matters=matters, numbers=numbers)


def _heat(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    """By the flash temperature of Jaeger's moving band for each contact zone, all heat into the counter-surface.

    The sum over the zones of one contact in one stroke is an upper bound.
    """
    into = {"conductivity": assumed.counter_conductivity, "heat_capacity": assumed.counter_heat_capacity}
    groups: dict[tuple[str, int], list[Strip]] = {}
    for strip in strips:
        groups.setdefault((strip.contact.name, id(strip.stroke)), []).append(strip)

    def rise(group: list[Strip], speed: float) -> float:
        mu = friction_range(scene, group[0].contact)[1]
        return sum(heat.band_rise(mu * s.pressure * speed, s.width / 2, speed, **into) for s in group)

    starts = min(onset(partial(rise, group), heat.LIMIT, low=1e-3, high=1e7) for group in groups.values())
    numbers = {"speed from which the flash temperature exceeds 10 K [mm/s]": starts}
    grounds = (
        "each zone as a band of uniform heat mu p v that moves over the counter-surface, which takes all heat (Jaeger; "
        f"rubber conducts {assumed.counter_conductivity / assumed.rubber_conductivity:.3g} times less)"
    )
    moving = [(group, speed) for group in groups.values() if (speed := group[0].stroke.speed) is not None]
    if not moving:
        words = f"{UNSAID}; the flash temperature exceeds {heat.LIMIT:g} K from {starts:.3g} mm/s on: {grounds}"
        return Verdict(words=words, matters=None, numbers=_finite(numbers))
    hottest, speed = max(moving, key=lambda pair: rise(*pair))
    strip = _main(hottest)
    found, mu = rise(hottest, speed), friction_range(scene, strip.contact)[1]
    power, unit = _power(scene, moving)
    numbers |= {
        "flash temperature [K]": found,
        "Péclet number of the counter-surface [-]": heat.peclet(speed, strip.width / 2, assumed.counter_diffusivity),
        f"frictional power [{unit}]": power,
    }
    matters: bool | None = found > heat.LIMIT
    limit = f"above {heat.LIMIT:g} K stiffness, losses and friction of rubber change, which this scene neglects"
    if not matters:
        limit = f"below the {heat.LIMIT:g} K that change stiffness, losses and friction of rubber"
    words = (
        f"estimated +{found:.2g} K of flash temperature at most: {limit}. Highest pressure of {len(hottest)} "
        f"{'zone' if len(hottest) == 1 else 'zones'}: {_where(strip)}, mu p v = {mu:.3g} x "
        f"{strip.pressure:.3g} MPa x {speed:.4g} mm/s, {strip.width:.3g} mm wide; {grounds}"
    )
    if all(stroke.speed is not None for stroke in scene.program.cycle):
        names = {strip.contact.name for strip in strips}
        warm = max(warming(scene, [s for s in strips if s.contact.name == name], assumed) for name in names)
        numbers["warming of the counter-surface over the program if nothing cools it [K]"] = warm
        words += f". In addition, {power:.2g} {unit} heat the counter-surface by {warm:.2g} K without cooling"
        if not matters and found + warm > heat.LIMIT:
            matters, words = None, f"{words}: this depends on the cooling, which no scene gives"
    return Verdict(words=words, matters=matters, numbers=_finite(numbers))


def _power(scene: Scene, groups: list[tuple[list[Strip], float]]) -> tuple[float, str]:
    """Highest frictional power of a contact in a stroke, and its unit, from zones and their speeds."""
    powers = []
    for group, speed in groups:
        load = sum(s.load * (2 * math.pi * s.place[1] if scene.axisymmetric else 1.0) for s in group)
        powers.append(1e-3 * friction_range(scene, group[0].contact)[1] * load * speed)
    return max(powers), "W" if scene.axisymmetric else "W/mm"


def _adhesion(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    """By pull-off force over load of the zone with the highest pressure, as a clean, dry, smooth line contact."""
    strip, modulus, work = _main(strips), scene.part.material.plane_strain_modulus, assumed.work_of_adhesion
    radius = adhesion.hertz_radius(strip.load, strip.width / 2, modulus)
    pull = adhesion.line_pull_off(radius, modulus, work)
    share = pull / strip.load
    tabor = adhesion.tabor(radius, modulus, work, assumed.equilibrium_distance)
    words = (
        f"clean, dry and smooth with {1e3 * work:g} J/m² the pull-off force would be {share:.2g} of the load "
        f"({strip.load:.3g} N/mm, {_where(strip)}; Johnson, Kendall and Roberts, for lines Barquins; Tabor's number "
        f"{tabor:.2g}); oil and roughness reduce it"
    )
    much = share > SHARE
    words += f". More than {SHARE:g}: it may matter if the contact is clean and dry" if much else ": negligible"
    numbers = {"pull-off force over load [-]": share, "Tabor's number [-]": tabor}
    return Verdict(words=words, matters=None if much else False, numbers=numbers)


def _inertia(scene: Scene, assumed: Assumed) -> Verdict:
    modulus, density = scene.part.material.shear_modulus, assumed.rubber_density
    wave = inertia.wave_speed(modulus, density)
    size = float((scene.part.outline.points.max(axis=0) - scene.part.outline.points.min(axis=0)).max())
    starts = min(math.sqrt(inertia.LIMIT), inertia.SLOW * min(s.travel for s in scene.program.cycle) / size) * wave
    numbers = {"speed of shear waves [m/s]": 1e-3 * wave, "speed from which inertia counts [mm/s]": starts}
    speeds = [stroke.speed for stroke in scene.program.cycle if stroke.speed is not None]
    if not speeds:
        words = f"{UNSAID}; inertia matters above {1e-3 * starts:.3g} m/s"
        return Verdict(words=words, matters=None, numbers=numbers)
    mach = inertia.mach_squared(max(speeds), modulus, density)
    turning = inertia.reversal(size, modulus, density, min(stroke.duration for stroke in scene.program.cycle))
    matters = mach > inertia.LIMIT or turning > inertia.SLOW
    words = (
        f"rho v²/G = {mach:.2g} (limit {inertia.LIMIT:g}), and a shear wave crosses the section in "
        f"{turning:.2g} of the shortest stroke (limit {inertia.SLOW:g}): "
        f"{'it matters' if matters else 'negligible'}. Vibrations excited by friction are not included"
    )
    numbers |= {"rho v²/G [-]": mach, "time of a shear wave through the section over the shortest stroke [-]": turning}
    return Verdict(words=words, matters=matters, numbers=numbers)


def _film(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    """By film thickness over roughness of a flooded soft line contact, for the zone with the highest pressure."""
    strip, modulus, oil = _main(strips), scene.part.material.plane_strain_modulus, assumed.oil_viscosity
    radius = adhesion.hertz_radius(strip.load, strip.width / 2, modulus)

    def ratio(speed: float) -> float:
        return film.line_film(oil, speed, strip.load, radius, modulus) / assumed.roughness

    starts = onset(ratio, film.MIXED)
    numbers = {"speed from which a film carries [mm/s]": starts}
    grounds = (
        f"flooded with oil of {1e6 * oil:g} Pa s (Herrebrugh, soft line contact; {1e3 * assumed.roughness:g} µm rough)"
    )
    if strip.stroke.speed is None:
        words = f"{UNSAID}. {grounds[0].upper()}{grounds[1:]}, a film would carry load above {starts:.3g} mm/s"
        return Verdict(words=words, matters=None, numbers=_finite(numbers))
    found = ratio(strip.stroke.speed)
    numbers |= {
        "Hersey number eta v / load [-]": film.hersey(oil, strip.stroke.speed, strip.load),
        "film over roughness [-]": found,
    }
    carries = found >= film.MIXED
    law = strip.contact.friction_law
    words = f"{_where(strip)}, {grounds}: film over roughness {found:.2g}, {film.regime(found)}"
    if not carries:
        return Verdict(words=words, matters=False, numbers=_finite(numbers))
    if law is not None and (law.depends_on_speed or law.breaks):
        words += ". The friction law of the contact includes it; film pressure and leakage are neglected"
        return Verdict(words=words, matters=False, numbers=_finite(numbers))
    if scene.fluid is None:
        words += ". The scene does not say whether there is oil; if so, friction and wear rate must include its effect"
        return Verdict(words=words, matters=None, numbers=_finite(numbers))
    words += ". Friction and wear rate must include its effect: they should depend on speed or lubrication"
    return Verdict(words=words, matters=True, numbers=_finite(numbers))


def _friction(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    strip = _main(strips)
    number = strip.pressure / scene.part.material.shear_modulus
    words = (
        f"mean pressure over G is {number:.2g} at {_where(strip)}: shear stress over G is that times mu, which is 0.05 "
        f"to 0.3 with oil and up to more than 1 dry; above {SHARE:g} friction changes the shape of the contact"
    )
    return Verdict(words=words, matters=True if number > SHARE else None, numbers={"mean pressure / G [-]": number})


def _wear(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    strip, way = _main(strips), scene.program.slid(scene.program.strokes)
    if way == 0:
        return Verdict(words="the program has no sliding", matters=False)
    rate = SHARE * strip.width / (strip.pressure * way)
    words = (
        f"over {way:.4g} mm a wear rate of {rate:.2g} mm²/N makes the zone at {_where(strip)} as deep as {SHARE:g} of "
        "its width, which changes the pressure"
    )
    return Verdict(words=words, matters=None, numbers={"wear rate from which it counts [mm²/N]": rate})


def _fluid(scene: Scene, strips: list[Strip], assumed: Assumed) -> Verdict:
    pressure = SHARE * _main(strips).peak
    words = f"the scene has no sealed fluid; its pressure matters above {SHARE:g} of the highest contact pressure"
    return Verdict(words=words, matters=None, numbers={"sealed pressure from which it counts [MPa]": pressure})
