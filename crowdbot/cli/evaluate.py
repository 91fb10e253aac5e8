"""``crowdbot evaluate``: score recordings again."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.core.run_directory import RECORD, RECORDING
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.evaluate import Scores
    from crowdbot.core.score import Score
    from crowdbot.core.trajectory import Trajectories


@dataclass(frozen=True, slots=True, kw_only=True)
class Recorded:
    """A recording to score, and what is known about it."""

    path: Path
    recording: Path
    robot_alone: Path | None = None
    crowd_alone: Path | None = None
    scenario: str = ""
    planner: str = ""
    seed: int | None = None


def evaluate(
    runs: Annotated[
        list[Path],
        typer.Argument(metavar="RUN_DIR|FILE.mcap...", help="Run directories or recordings."),
    ],
    robot_alone: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Recording of the same robot without people."),
    ] = None,
    crowd_alone: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Recording of the same people without robot."),
    ] = None,
    metrics: Annotated[str, typer.Option(metavar="GLOB", help="Which metrics.")] = "*",
    variant: Annotated[str, typer.Option(metavar="NAME|all", help="Which variants.")] = "all",
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Score recorded runs. Nothing is simulated or written.

    Example: crowdbot evaluate runs/challenge-2020/counter-d0500-fast-c20-r05/dwa/seed-0
    """
    from crowdbot.core.evaluate import score
    from crowdbot.core.registry import discover

    registry = discover()
    results = []
    for path in runs:
        recorded = find_recorded(path, robot_alone, crowd_alone)
        scores = score(
            registry,
            _read(recorded.recording),
            _read_reference(recorded.robot_alone),
            _read_reference(recorded.crowd_alone),
            metrics=metrics,
            variants=variant,
        )
        results.append((recorded, scores))
    if as_json:
        typer.echo(json.dumps([_document(*r) for r in results], indent=2, allow_nan=False))
    else:
        for result in results:
            _print(*result)


def find_recorded(
    path: Path, robot_alone: Path | None = None, crowd_alone: Path | None = None
) -> Recorded:
    """Where the recording of a run and its references are; given references win.

    Raises:
        InputError: there is no such run or file, or run.json is no record of a run.
    """
    if path.is_dir():
        found = _in_directory(path)
    elif path.is_file():
        found = Recorded(path=path, recording=path)
    else:
        raise InputError(f"{path}: no such run directory or recording")
    found = dataclasses.replace(
        found,
        robot_alone=robot_alone or found.robot_alone,
        crowd_alone=crowd_alone or found.crowd_alone,
    )
    for what in ("recording", "robot_alone", "crowd_alone"):
        file = getattr(found, what)
        if file is not None and not file.is_file():
            raise InputError(f"{path}: {what.replace('_', ' ')} not found: {file}")
    return found


def _in_directory(folder: Path) -> Recorded:
    record = _record(folder)
    references = record.get("references") or {}
    seed = record.get("seed")
    if not isinstance(references, Mapping) or not isinstance(seed, int | None):
        raise InputError(f"{folder / RECORD}: 'references' or 'seed' is malformed")
    return Recorded(
        path=folder,
        recording=folder / RECORDING,
        robot_alone=_beside(folder, references.get("robot_alone")),
        crowd_alone=_beside(folder, references.get("crowd_alone")),
        scenario=str(record.get("scenario") or ""),
        planner=_name(record.get("planner")),
        seed=seed,
    )


def _record(folder: Path) -> Mapping[str, Any]:
    """run.json; an interrupted run may have none."""
    file = folder / RECORD
    if not file.is_file():
        if folder.name.endswith(".partial"):
            return {}
        raise InputError(f"{folder}: no run directory: {RECORD} is missing")
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: cannot be read: {error}") from error
    if not isinstance(record, Mapping):
        raise InputError(f"{file}: not a record of a run")
    return record


def _beside(folder: Path, reference: object) -> Path | None:
    return None if reference is None else folder / str(reference)


def _name(planner: object) -> str:
    """A planner is recorded by name, or as its document and name."""
    if isinstance(planner, Mapping):
        planner = planner.get("name") or planner.get("kind")
    return str(planner or "")


def _read(path: Path) -> Trajectories:
    from crowdbot.core.recording import read_trajectories

    return read_trajectories(path)


def _read_reference(path: Path | None) -> Trajectories | None:
    return None if path is None else _read(path)


def _document(recorded: Recorded, scores: Scores) -> dict[str, Any]:
    return {
        "run": str(recorded.path),
        "scenario": recorded.scenario,
        "planner": recorded.planner,
        "seed": recorded.seed,
        "scores": [_fields(s) for s in scores],
    }


def _fields(score: Score) -> dict[str, Any]:
    values = {f.name: getattr(score, f.name) for f in dataclasses.fields(score)}
    return {**values, "extras": dict(score.extras)}


def _print(recorded: Recorded, scores: Scores) -> None:
    from rich.console import Console
    from rich.text import Text

    from crowdbot.core.scores_table import scores_table

    seed = "" if recorded.seed is None else f"seed {recorded.seed}"
    title = " ".join(filter(None, (recorded.scenario, recorded.planner, seed)))
    console = Console(highlight=False)
    console.print(Text(title or str(recorded.path), style="bold"), soft_wrap=True)
    console.print(scores_table(scores))
