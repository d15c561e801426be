"""The result of a run: quantities with their errors, outlines, pressures, figures, and NGSolve objects."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ngwear.errors import ResultError
from ngwear.files.result_folder import SUMMARY
from ngwear.results.closing_table import closing_table
from ngwear.results.result_file import Snapshot, read_result

if TYPE_CHECKING:
    import ngsolve as ng
    from matplotlib.figure import Figure

    from ngwear.loop.state import State
    from ngwear.results.recorder import Recorder

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ContactPressure:
    """Pressure along one contact in one stroke; the arrays have one value for each node, along the outline.

    Attributes
    ----------
    contact, kind : str
        Names of contact and stroke.
    stroke : float
        Number of the stroke.
    along : array, shape (n,)
        Arc length along the deformed outline from the first node [mm].
    place : array, shape (n, 2)
        Deformed position of the nodes [mm].
    pressure : array, shape (n,)
        Cauchy pressure [MPa].
    gap : array, shape (n,)
        Distance to the surface [mm].
    """

    contact: str
    kind: str
    stroke: float
    along: Array
    place: Array
    pressure: Array
    gap: Array

    @property
    def table(self) -> dict[str, Array]:
        """Columns by name and unit, as ``pandas.DataFrame`` takes them."""
        return {
            "along [mm]": self.along,
            "x [mm]": self.place[:, 0],
            "y [mm]": self.place[:, 1],
            "pressure [MPa]": self.pressure,
            "gap [mm]": self.gap,
        }


@dataclass(frozen=True)
class Result:
    """Result of a run; ``print(result)`` shows a table of the quantities with their estimated errors.

    Attributes
    ----------
    status : str
        ``"completed"`` or ``"gave up"``.
    message : str
        Why the run stopped.
    summary : dict
        Contents of ``summary.json``.
    recorder : Recorder or None
        Rows (as in ``series.csv``) and snapshots; None if the result is read from a folder.
    state : State or None
        The last accepted state; None if the part could not be mounted, or the result is read from a folder.
    error : Exception or None
        The error at which the run gave up.
    folder : Path or None
        Folder of its files.
    """

    status: str
    message: str
    summary: dict[str, Any]
    recorder: Recorder | None
    state: State | None
    error: Exception | None = None
    folder: Path | None = None

    @classmethod
    def read(cls, folder: Path | str) -> Result:
        """Read the result of a run from its folder.

        Raises
        ------
        ResultError
            If there is no ``summary.json``, or it is damaged.
        """
        file = Path(folder) / SUMMARY
        try:
            summary = json.loads(file.read_text(encoding="utf-8"))
            return cls(summary["status"], summary["message"], summary, None, None, folder=Path(folder))
        except OSError:
            raise ResultError(f"{file} does not exist: give the folder of a finished run") from None
        except (ValueError, KeyError, TypeError) as error:
            raise ResultError(f"{file} cannot be read as a summary of ngwear: {error!r}") from error

    def __str__(self) -> str:
        return closing_table(self.summary)

    @cached_property
    def series(self) -> dict[str, NDArray[Any]]:
        """Columns of ``series.csv``, one value for each solved stroke; input for ``pandas.DataFrame``."""
        if self.recorder is None:
            return dict(read_result(self._folder).series)
        rows = self.recorder.rows
        return {name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())}

    @cached_property
    def snapshots(self) -> Sequence[Snapshot]:
        """Outline and contact pressures of each solved stroke."""
        return read_result(self._folder).snapshots if self.recorder is None else self.recorder.snapshots

    @property
    def worn_profile(self) -> Array:
        """Outline at the end of the run, shape (n, 2) [mm]; closed, the first point is not repeated."""
        return self.outline()

    def outline(self, stroke: float | None = None) -> Array:
        """Outline after a solved stroke, default the last, shape (n, 2) [mm]; stroke 0 is the unworn outline.

        Raises
        ------
        ResultError
            If the stroke was not saved.
        """
        return self._at(stroke, None).outline

    def pressure(
        self, contact: str | None = None, *, stroke: float | None = None, kind: str | None = None
    ) -> ContactPressure:
        """Pressure along a contact in a solved stroke.

        Parameters
        ----------
        contact : str or None
            Name of the contact; default the first one.
        stroke : float or None
            Number of the stroke; default the last one.
        kind : str or None
            Name of the stroke in the cycle, if several were solved at this number, as at the end.

        Returns
        -------
        ContactPressure

        Raises
        ------
        ResultError
            If the stroke or the contact was not saved.
        """
        found = self._at(stroke, kind)
        names = list(found.profiles)
        name = names[0] if contact is None and names else contact
        if name is None or name not in found.profiles:
            raise ResultError(f"the pressure of contact {name!r} was not saved; saved: {names} (see 'refine')")
        profile = found.profiles[name]
        place = profile["place [mm]"]
        steps = np.linalg.norm(np.diff(place, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)]) if len(place) else np.empty(0)
        return ContactPressure(
            name, found.kind, found.stroke, along, place, profile["pressure [MPa]"], profile["gap [mm]"]
        )

    def plot(self, field: str = "von Mises stress", *, stroke: float | None = None, kind: str | None = None) -> Figure:
        """Figure of the loaded section coloured by a field, with the surfaces and the contact pressures.

        Parameters
        ----------
        field : str
            A name in ``ngwear.results.section.FIELDS``, with or without its unit.
        stroke : float or None
            A stroke whose section was saved; default the last one.
        kind : str or None
            Name of the stroke in the cycle; default the one with the highest fluid pressure.

        Raises
        ------
        ResultError
            If there is no such field, or the section of the stroke was not saved.
        """
        from ngwear.plots.loaded_section import draw_section

        kept = read_result(self._folder) if self.recorder is None else self.recorder.sections
        return draw_section(kept, field=field, stroke=stroke, kind=kind)

    @property
    def mesh(self) -> ng.Mesh:
        """NGSolve mesh of the worn section, undeformed.

        Raises
        ------
        ResultError
            If the result is read from a folder, or the part could not be mounted.
        """
        return self._final_state.stage.body.mesh

    @property
    def displacement(self) -> ng.GridFunction:
        """NGSolve displacement on ``mesh`` at the end of the last stroke [mm]; raises errors as ``mesh``."""
        from ngwear.effects.base import DISPLACEMENT

        return self._final_state.stage.problem.fields[DISPLACEMENT]

    @cached_property
    def stress(self) -> ng.CoefficientFunction:
        """NGSolve Cauchy stress on ``mesh``, 3 x 3, third row and column out of plane [MPa]; raises errors as ``mesh``.

        For rubber with memory it is the long-term part only.
        """
        from ngwear.loop.stress import cauchy_stress

        return cauchy_stress(self._final_state.stage)

    @property
    def records(self) -> Recorder:
        """``recorder``; ResultError if the result is read from a folder."""
        if self.recorder is None:
            raise ResultError("a result read from a folder has no records: use 'series'")
        return self.recorder

    @property
    def end(self) -> State:
        """``state``; ResultError if there is none."""
        if self.state is None:
            raise ResultError("a result read from a folder has no mesh and no fields: run the scene in this process")
        return self.state

    @property
    def _final_state(self) -> State:
        """The state, with the displacement at the end of the last stroke set in the problem."""
        state = self.end
        if state.phases:
            latest = state.reports[-1].phase if state.reports else -1
            state.stage.problem.state.vec.FV().NumPy()[:] = state.phases[latest].vector
        return state

    @property
    def _folder(self) -> Path:
        if self.folder is None:
            raise ResultError("the run has no folder: give it one by out=...")
        return self.folder

    def _at(self, stroke: float | None, kind: str | None) -> Snapshot:
        kept = [s for s in self.snapshots if kind is None or s.kind == kind]
        if not kept:
            kinds = list(dict.fromkeys(s.kind for s in self.snapshots))
            raise ResultError(f"no stroke is called {kind!r}; the cycle has {kinds}")
        if stroke is None:
            return kept[-1]
        found = [s for s in kept if s.stroke == stroke]
        if not found:
            near = sorted(dict.fromkeys(s.stroke for s in kept), key=lambda number: abs(number - stroke))[:4]
            nearest = ", ".join(f"{number:g}" for number in sorted(near))
            raise ResultError(
                f"stroke {stroke:g} was not saved: a jump passed over it; the nearest saved strokes are {nearest}; "
                "give save.strokes in the scene to save others"
            )
        return found[-1]
