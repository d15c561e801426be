"""Checkpoint of a run: its state and its records, written after each step, to continue a stopped run."""

from __future__ import annotations

from ngwear.effects.contact_profile import ContactProfile
from ngwear.equilibrium.stepping import Work
from ngwear.errors import ResultError
from ngwear.files.archive import Format, packed, read, write
from ngwear.files.result_folder import CHECKPOINT
from ngwear.geometry.body import Body
from ngwear.geometry.cells import Cells, Fate
from ngwear.geometry.outline import Outline
from ngwear.geometry.sizing import SizeField
from ngwear.loop.solution_checks import Finding
from ngwear.loop.state import LastWear, Ledger, Phase, State, StrokeReport
from ngwear.results.recorder import Folder, Recorder
from ngwear.results.result_file import Snapshot
from ngwear.scene.accuracy import Accuracy
from ngwear.scene.scene import Scene
from ngwear.surfaces import WornProfile
from ngwear.wear.jump_control import JumpControl

FORMAT = Format("checkpoint", 4, "remove the folder and run again, or give another one")  # 1: a pickle
PLAIN = (
    Finding,
    Accuracy,
    Cells,
    ContactProfile,
    Fate,
    JumpControl,
    LastWear,
    Ledger,
    Outline,
    Phase,
    SizeField,
    Snapshot,
    StrokeReport,
    Work,
    WornProfile,
)


def classes(scene: Scene) -> tuple[type, ...]:
    """Classes of the objects in a checkpoint of the scene; modules that the scene does not need are not imported."""
    found: list[type] = list(PLAIN)
    if scene.fluid is not None:
        from ngwear.effects.blow_by import BlowBy

        found.append(BlowBy)
    if scene.deactivation is not None:
        from ngwear.geometry.element_body import ElementBody

        return (*found, ElementBody)
    if scene.arms is None:
        return (*found, Body)
    from ngwear.fields.background_mesh import Background
    from ngwear.loop.memory_over_cycles import CycleMemory

    return (*found, Body, Background, CycleMemory)


def save(folder: Folder, state: State, recorder: Recorder) -> None:
    """Write checkpoint and series."""
    content = {"scene": folder.scene_hash, "state": state.to_data(), "recorder": recorder.to_data()}
    members = packed(content, FORMAT, classes(recorder.scene))
    folder.replace(CHECKPOINT, lambda file: write(file, members))
    folder.write_series(recorder.rows)


def load(folder: Folder, scene: Scene) -> tuple[State, Recorder] | None:
    """State and records of the run to continue; None if the folder has no checkpoint.

    Raises
    ------
    ResultError
        If the checkpoint is damaged, of another version, or of another scene.
    """
    file = folder.path / CHECKPOINT
    if not file.exists():
        return None
    content = read(file, FORMAT, classes(scene))
    try:
        if content["scene"] == folder.scene_hash:
            return State.from_data(content["state"], scene), Recorder.from_data(content["recorder"], scene)
    except Exception as error:  # inconsistent data may raise any error
        raise ResultError(f"{file} cannot be read as a checkpoint ({error}); {FORMAT.remedy}") from error
    raise ResultError(f"{folder.path} holds a run of another scene, or the scene was changed: give another folder")
