"""Scene of a pin that slides on a rubber sheet at several speeds, as frozen dataclasses."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from ngwear.errors import SceneError, check_fields
from ngwear.laws import FrictionLaw, law_of
from ngwear.materials import Folding, Hyperelastic, PronySeries

KIND = "pin on plate"


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A rigid hemisphere pressed on a rubber sheet whose bottom is bonded to a rigid plate.

    Parameters
    ----------
    material : Hyperelastic
        Long-term hyperelastic behaviour.
    series : PronySeries or None
        Viscoelastic arms at the sheet's temperature; None: elastic rubber.
    radius : float
        Radius of the ball [mm].
    load : float
        Normal force [N].
    thickness : float
        Thickness of the sheet [mm].
    track_radius : float
        Radius of the circular track [mm]; infinite for a straight track.
    sheet_radius : float
        Outer radius of the sheet [mm]; sheet and circular track have the same centre.
    friction : FrictionLaw or float
        Coefficient of surface friction [-]. Laws over the sliding distance are refused: steady sliding has none.

    Raises
    ------
    SceneError
        For a size or load that is not positive, or a track that leaves the sheet.
    """

    material: Hyperelastic
    series: PronySeries | None
    # Sizes, load and friction of case C2 (10.5772/50498).
    radius: float = 5.0
    load: float = 100.0
    thickness: float = 4.0
    track_radius: float = 16.5
    sheet_radius: float = 30.0
    friction: FrictionLaw | float = 0.06

    def __post_init__(self) -> None:
        for name in ("radius", "load", "thickness", "track_radius", "sheet_radius"):
            if not getattr(self, name) > 0:
                raise SceneError(f"pin.{name}", getattr(self, name), "must be greater than 0")
        if not isinstance(self.friction, FrictionLaw) and not self.friction >= 0:
            raise SceneError("pin.friction", self.friction, "must be at least 0")
        if self.friction_law is not None and self.friction_law.breaks:
            raise SceneError(
                "pin.friction",
                self.friction,
                "depends on the sliding distance, which steady sliding does not have: give a number",
            )
        needed = self.track_radius + 2 * self.contact_radius
        if math.isfinite(self.track_radius) and needed > self.sheet_radius:
            raise SceneError(
                "pin.sheet_radius",
                self.sheet_radius,
                f"the track leaves the sheet: with a contact of about {self.contact_radius:.2g} mm around a track of "
                f"{self.track_radius:g} mm take {needed:.3g} mm or more",
            )

    @property
    def friction_law(self) -> FrictionLaw | None:
        """The law of surface friction; None without friction."""
        return law_of(self.friction)

    @property
    def arms(self) -> PronySeries:
        """The Prony series; SceneError for elastic rubber."""
        if self.series is None:
            raise SceneError("pin.series", None, "is missing: without memory steady sliding does not depend on speed")
        return self.series

    @property
    def contact_radius(self) -> float:
        """Estimated contact radius, between Hertz on a half-space and a thin bonded layer [mm]."""
        modulus = 4 * self.material.shear_modulus
        hertz = (0.75 * self.load * self.radius / modulus) ** (1 / 3)
        return hertz / (1 + (hertz / self.thickness) ** 2) ** 0.25


@dataclass(frozen=True, kw_only=True)
class PinMesh:
    """Mesh of a pin scene.

    Parameters
    ----------
    patch, coarse : float
        Element edge in the contact, and far from it [mm].
    column : float
        Width of the columns of the grid on which the memory is integrated, in the contact [mm].
    reach, beside : float
        Half length of the meshed block along the track, and half width across it, over the sheet's thickness [-].
    folding_error : float
        Largest relative error of stress by relaxation times that are left out [-].

    Raises
    ------
    SceneError
        For a size that is not positive.
    """

    # Settled on the shipped pin: two meshes differ by 1.0 % of the friction (``verify pin_on_plate``; ``ngwear cost``).
    patch: float = 0.5
    coarse: float = 3.0
    column: float = 0.2
    reach: float = 5.0
    beside: float = 3.5
    folding_error: float = 1e-3

    def __post_init__(self) -> None:
        check_fields(self, "accuracy")
        for name in ("patch", "coarse", "column", "reach", "beside"):
            if not 0 < getattr(self, name) < math.inf:
                raise SceneError(f"accuracy.{name}", getattr(self, name), "must be finite and greater than 0")
        if self.coarse < self.patch:
            raise SceneError("accuracy.coarse", self.coarse, "must be at least the patch size")
        if not 0 <= self.folding_error < 1:
            raise SceneError("accuracy.folding_error", self.folding_error, "must be at least 0, below 1")

    def folding(self, series: PronySeries, speed: float) -> Folding:
        """Leave out the arms that relax while the rubber passes one column at this speed [mm/s].

        No arm becomes a spring: in the steady state even the slowest arm has the mean of all turns.
        """
        return series.folded(shortest=self.column / speed, longest=math.inf, tolerance=self.folding_error)


@dataclass(frozen=True, kw_only=True)
class PinScene:
    """A pin that slides on a rubber sheet in steady state, at several speeds.

    Parameters
    ----------
    name : str
    pin : Pin
    speeds : tuple of float
        Sliding speeds [mm/s], each > 0.
    mesh : PinMesh
    vtk : bool
        Whether to write the deformed sheet for ParaView, one file for each speed.

    Raises
    ------
    SceneError
        If a speed is not positive or given twice, or the rubber has no memory.
    """

    name: str
    pin: Pin
    speeds: tuple[float, ...]
    mesh: PinMesh = field(default_factory=PinMesh)
    vtk: bool = False

    def __post_init__(self) -> None:
        if not self.speeds:
            raise SceneError("program.speeds", self.speeds, "give at least one speed")
        for i, speed in enumerate(self.speeds):
            if not 0 < speed < math.inf:
                raise SceneError(f"program.speeds[{i}]", speed, "steady sliding needs a speed above 0 mm/s")
            if speed in self.speeds[:i]:
                raise SceneError(f"program.speeds[{i}]", speed, "is given twice")
        if self.pin.series is None:
            raise SceneError(
                "material.prony",
                None,
                "is missing: without memory the friction of steady sliding does not depend on speed",
            )

    def write(self, path: Path | str) -> None:
        """Write the scene to a ``.toml`` file.

        Raises
        ------
        SceneError
            If a scene file cannot represent something, such as a user-defined law or material.
        """
        from ngwear.scene.write_scene import write_pin_scene

        write_pin_scene(self, Path(path))
