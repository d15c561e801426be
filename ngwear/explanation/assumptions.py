"""Constants that no scene gives, with their sources."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

from ngwear.errors import SceneError


@dataclass(frozen=True, kw_only=True)
class Assumed:
    """Constants for the estimates of neglected effects, in units of mm, N, MPa, s, t, K; each can be replaced.

    Parameters
    ----------
    counter_conductivity : float
        Heat conductivity of the counter-surface [W/(m K) = N/(s K)]; steel, 40 to 60 plain and low-alloyed, 15
        stainless (Incropera & DeWitt, *Fundamentals of Heat and Mass Transfer*, table A.1).
    counter_heat_capacity : float
        Volumetric heat capacity of the counter-surface [MJ/(m³ K) = MPa/K]; steel, 7.85 g/cm³ times 0.434 J/(g K), the
        same table.
    rubber_conductivity : float
        Heat conductivity of the rubber [W/(m K)]; NBR, see ``materials.library``.
    rubber_heat_capacity : float
        Volumetric heat capacity of the rubber [MPa/K]; 2, a rounded value for filled rubber.
    rubber_density : float
        Density of the rubber [t/mm³]; filled NBR, 1.1 to 1.3 g/cm³ in data sheets.
    work_of_adhesion : float
        Work of adhesion of rubber on a clean, dry, smooth surface [N/mm]; 0.05 J/m² is that of van der Waals forces
        between polymers (Israelachvili, *Intermolecular and Surface Forces*). Roughness and oil reduce it.
    equilibrium_distance : float
        Distance of the atoms of both surfaces [mm]; 0.3 nm, between his cut-off of 0.165 nm and the 0.4 nm of
        molecules.
    oil_viscosity : float
        Dynamic viscosity of the oil [MPa s]; 0.04 Pa s is that of a hydraulic oil ISO VG 46 (46 mm²/s at 40 degrees
        Celsius, ISO 3448) of 0.87 g/cm³.
    roughness : float
        Combined rms roughness of both surfaces [mm]; 0.5 µm for a ground rod and a moulded seal.

    Raises
    ------
    SceneError
        If a value is not finite and positive.
    """

    counter_conductivity: float = 50.0
    counter_heat_capacity: float = 3.4
    rubber_conductivity: float = 0.25
    rubber_heat_capacity: float = 2.0
    rubber_density: float = 1.2e-9
    work_of_adhesion: float = 5e-5
    equilibrium_distance: float = 3e-7
    oil_viscosity: float = 4e-8
    roughness: float = 5e-4

    def __post_init__(self) -> None:
        for name, value in self.as_dict().items():
            if not 0 < value < math.inf:
                raise SceneError(f"assumed.{name}", value, "must be finite and greater than 0")

    @property
    def counter_diffusivity(self) -> float:
        """Thermal diffusivity of the counter-surface [mm²/s]."""
        return self.counter_conductivity / self.counter_heat_capacity

    @property
    def rubber_diffusivity(self) -> float:
        """Thermal diffusivity of the rubber [mm²/s]."""
        return self.rubber_conductivity / self.rubber_heat_capacity

    def as_dict(self) -> dict[str, float]:
        """The constants by name."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def in_data_sheet_units(self) -> dict[str, float]:
        """The constants in the units of data sheets."""
        return {
            "counter-surface: conductivity [W/(m K)]": self.counter_conductivity,
            "counter-surface: heat capacity [MJ/(m³ K)]": self.counter_heat_capacity,
            "rubber: conductivity [W/(m K)]": self.rubber_conductivity,
            "rubber: heat capacity [MJ/(m³ K)]": self.rubber_heat_capacity,
            "rubber: density [g/cm³]": 1e9 * self.rubber_density,
            "work of adhesion, clean and dry [J/m²]": 1e3 * self.work_of_adhesion,
            "distance of the surfaces' atoms [nm]": 1e6 * self.equilibrium_distance,
            "oil: dynamic viscosity [Pa s]": 1e6 * self.oil_viscosity,
            "roughness of both surfaces, rms [µm]": 1e3 * self.roughness,
        }

    def replaced(self, changes: Sequence[str]) -> Assumed:
        """Replace values by texts ``name=value``, in units of mm, N, MPa, s, t, K.

        Raises
        ------
        SceneError
            If a name is unknown or a value is not a number.
        """
        values = {}
        for change in changes:
            name, _, text = change.partition("=")
            if name not in self.as_dict():
                raise SceneError("assumed", name, f"unknown constant; known: {list(self.as_dict())}")
            try:
                values[name] = float(text)
            except ValueError:
                raise SceneError(f"assumed.{name}", text, f"must be a number, as in {name}=1e-3") from None
        return replace(self, **values)
