"""Find the recordings of a run and of its references."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from crowdbot.core.runs.run_directory import (
    RECORD,
    RECORDING,
    changed,
    checked_record,
    is_bag,
    is_for_results,
)
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingSource:
    """A recording to score, and known facts about it.

    Attributes:
        path: the user's path, or a run directory below it.
        planner: name of the planner; ``label`` also distinguishes its parameters.
        hashes: trajectory hash of each calibration run, as the run's record has it.
    """

    path: Path
    recording: Path
    robot_alone: Path | None = None
    crowd_alone: Path | None = None
    scenario: str = ""
    planner: str = ""
    label: str = ""
    seed: int | None = None
    hashes: Mapping[str, str] = field(default_factory=dict)


def expand_paths(paths: Iterable[Path]) -> list[Path]:
    """Return files and run directories; other directories are replaced by the runs below.

    Calibration runs and unfinished runs are skipped.
    """
    found: list[Path] = []
    for path in paths:
        plain = not path.is_dir() or (path / RECORD).exists() or path.name.endswith(".partial")
        below = [] if plain else sorted(r.parent for r in path.rglob(RECORD) if _is_run(r, path))
        found += below or [path]
    return found


def find_source(
    path: Path, robot_alone: Path | None = None, crowd_alone: Path | None = None
) -> RecordingSource:
    """Return the recording of one run directory or file; explicit references take precedence.

    Raises:
        InputError: there is no such run or file, or run.json is not a record of a run.
    """
    if path.is_dir():
        source = _in_directory(path)
    elif path.exists():
        source = RecordingSource(path=path, recording=path)
    else:
        raise InputError(f"{path}: no such run directory or recording")
    given = {"robot_alone": robot_alone, "crowd_alone": crowd_alone}
    source = replace(
        source,
        hashes={name: sha for name, sha in source.hashes.items() if given.get(name) is None},
        robot_alone=robot_alone or source.robot_alone,
        crowd_alone=crowd_alone or source.crowd_alone,
    )
    for part in ("recording", "robot_alone", "crowd_alone"):
        file = getattr(source, part)
        if file is not None and not file.is_file():
            raise InputError(f"{path}: {part.replace('_', ' ')} not found: {file}")
    return source


def _is_run(record: Path, root: Path) -> bool:
    return not is_bag(record.parent) and is_for_results(record.parent, root)


def _in_directory(folder: Path) -> RecordingSource:
    record = _record(folder)
    if wrong := changed(folder, record, (RECORDING,)):
        raise InputError(f"{folder}: {wrong}")
    references = record.get("references") or {}
    seed = record.get("seed")
    if not isinstance(references, Mapping) or not isinstance(seed, int | None):
        raise InputError(f"{folder / RECORD}: 'references' or 'seed' is malformed")
    planner, hashes = record.get("planner"), record.get("reference_hashes")
    return RecordingSource(
        path=folder,
        recording=folder / RECORDING,
        robot_alone=_beside(folder, references.get("robot_alone")),
        crowd_alone=_beside(folder, references.get("crowd_alone")),
        scenario=str(record.get("scenario") or ""),
        planner=_name(planner, "name", "kind"),
        label=_name(planner, "label", "name", "kind"),
        seed=seed,
        hashes=hashes if isinstance(hashes, Mapping) else {},
    )


def _record(folder: Path) -> Mapping[str, Any]:
    """Return run.json; an interrupted run may have none."""
    file = folder / RECORD
    if not file.is_file():
        if folder.name.endswith(".partial"):
            return {}
        raise InputError(f"{folder}: no run directory: {RECORD} is missing")
    return checked_record(folder)


def _beside(folder: Path, reference: object) -> Path | None:
    return None if reference is None else folder / str(reference)


def _name(planner: object, *keys: str) -> str:
    """Return the planner's name, from a name or from its document."""
    if isinstance(planner, Mapping):
        planner = next((planner[k] for k in keys if planner.get(k)), "")
    return str(planner or "")
