"""Rubber compounds as a first estimate, each constant with its source. None was measured for ngwear."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ngwear.errors import SceneError
from ngwear.materials.mooney_rivlin import MooneyRivlin
from ngwear.materials.prony import PronySeries
from ngwear.materials.shift import WLF

INVENTED = "representative, not measured"
GENT = "Gent, Rubber Chem. Technol. 31 (1958) 896: Young's modulus from Shore A hardness"
FILLED = (
    "representative, not measured: non-negative Prony fit, one arm a decade, to a public filled-rubber master curve"
)
ROOM = 296.15  # K: 23 degrees Celsius, the standard atmosphere of ISO 23529

# Uniaxial moduli [MPa] of the arms at 3.16e-7 ... 31.6 s, and the long-term one: see ``FILLED``.
FILLED_ARMS = (31.59, 8.066, 5.818, 3.336, 2.444, 1.852, 1.133, 1.311, 1.070)
FILLED_TIMES = tuple(10 ** (k + 0.5) for k in range(-7, 2))
FILLED_LONG_TERM = 5.352

GLASS = {"EPDM": 218.0, "NBR": 243.0, "HNBR": 248.0, "FKM": 258.0}  # glass temperatures [K]
CONDUCTIVITY = {"EPDM": 0.26, "NBR": 0.25, "HNBR": 0.25, "FKM": 0.10}  # W/(m K)


@dataclass(frozen=True, kw_only=True)
class Compound:
    """A rubber compound: long-term elasticity, relaxation, and the time-temperature shift.

    Attributes
    ----------
    name : str
    elastic : MooneyRivlin
        Long-term (relaxed) elasticity.
    prony : PronySeries
        Relaxation relative to it, at the reference temperature of ``shift``.
    shift : WLF
    constants : mapping of str to float
        Further constants, by names with units.
    sources : mapping of str to str
        Source of each attribute above and of each constant.
    """

    name: str
    elastic: MooneyRivlin
    prony: PronySeries
    shift: WLF
    constants: Mapping[str, float] = field(default_factory=dict)
    sources: Mapping[str, str]

    def at(self, temperature: float) -> PronySeries:
        """Prony series at a temperature [K]."""
        return self.prony.shifted(self.shift.factor(temperature))


def young_from_hardness(shore_a: float) -> float:
    """Young's modulus [MPa] of a Shore A hardness, ``0.0981 (56 + 7.62336 S) / (0.137505 (254 - 2.54 S))``.

    Source: Gent (1958). Meant for 20 to 90 Shore A.
    """
    if not 20 <= shore_a <= 95:
        raise SceneError("hardness", shore_a, "Gent's relation holds from 20 to about 90 Shore A")
    return 0.0981 * (56 + 7.62336 * shore_a) / (0.137505 * (254 - 2.54 * shore_a))


def filled_rubber() -> Compound:
    """Filled rubber with a nearly flat loss factor from 0.1 to 1000 Hz (0.11 to 0.18); 9 arms, K = 2000 MPa."""
    sum_of_constants = FILLED_LONG_TERM / 6
    return Compound(
        name="filled rubber",
        elastic=MooneyRivlin(c10=0.8 * sum_of_constants, c01=0.2 * sum_of_constants, bulk_modulus=2000.0),
        prony=PronySeries.from_moduli(FILLED_ARMS, FILLED_TIMES, long_term=FILLED_LONG_TERM),
        shift=WLF.above_glass(223.0, ROOM),
        sources={
            "elastic": f"{FILLED}; C10 : C01 = 4 : 1 and K invented",
            "prony": FILLED,
            "shift": f"universal WLF constants (Williams, Landel & Ferry 1955) about 223 K, {INVENTED}",
        },
    )


def relaxation_of(name: str) -> tuple[PronySeries, WLF]:
    """Prony series and shift of ``"filled rubber"``, or of a polymer (with the filled rubber's Prony series)."""
    if name == "filled rubber":
        found = filled_rubber()
    elif name in GLASS:
        found = compound(name, hardness=70.0)  # the ratios of the arms do not depend on it
    else:
        raise SceneError("material.prony.compound", name, f"known: 'filled rubber', {', '.join(GLASS)}")
    return found.prony, found.shift


def compound(polymer: str, *, hardness: float) -> Compound:
    """A seal compound by polymer (EPDM, NBR, HNBR, FKM) and Shore A hardness.

    The long-term modulus follows from the hardness (a hardness test lasts seconds). The Prony series is the filled
    rubber's at 296 K, shifted by the polymer's glass temperature. Use it as a first estimate only.
    """
    if polymer not in GLASS:
        raise SceneError("material.compound", polymer, f"known: {', '.join(GLASS)} and 'filled rubber'")
    total = young_from_hardness(hardness) / 6
    return Compound(
        name=f"{polymer} {hardness:g} Shore A",
        elastic=MooneyRivlin(c10=0.8 * total, c01=0.2 * total, bulk_modulus=2000.0 * total),
        prony=filled_rubber().prony,
        shift=WLF.above_glass(GLASS[polymer], ROOM),
        constants={"thermal conductivity [W/(m K)]": CONDUCTIVITY[polymer], "glass temperature [K]": GLASS[polymer]},
        sources={
            "elastic": f"{GENT}; C10 : C01 = 4 : 1 and K/G = 1000 {INVENTED}",
            "prony": f"{FILLED}; taken for this polymer without evidence",
            "shift": f"universal WLF constants about the glass temperature, {INVENTED}",
            "thermal conductivity [W/(m K)]": "a supplier's table" if polymer != "HNBR" else f"NBR's, {INVENTED}",
            "glass temperature [K]": INVENTED,
        },
    )
