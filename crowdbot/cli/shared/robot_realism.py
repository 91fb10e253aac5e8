"""``crowdbot realism --robot``: compare people's response to robots with recorded people."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.say import say
from crowdbot.core.runs.run_directory import recordings_under
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import InputError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from crowdbot.core.realism.near_robots.measure import RobotRealism
    from crowdbot.core.realism.near_robots.reference import RobotReference
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.trajectories.data_sets.homography import VideoScale

T = TypeVar("T")

#: Draws by default: the index of single draws varies by 0.02.
DRAWS = 2


def of_people(
    homography: str | None, frame_rate: float | None, files: Sequence[Path] | None, *, robot: bool
) -> VideoScale:
    """Return the scale of tables in pixels and frames, from the values of the two options.

    Raises:
        UsageError: it is given without a file, or with ``--robot``, whose tables are metric.
        InputError: as for `video_scale`.
    """
    from crowdbot.core.trajectories.data_sets.homography import video_scale

    scale = video_scale(homography, frame_rate)
    if scale and not files:
        raise UsageError("--homography and --frame-rate are for the files of --reference")
    if scale and robot:
        raise UsageError(
            "--homography and --frame-rate are for tables of people alone; those of --robot have "
            "metres and seconds"
        )
    return scale


def robot_realism(
    text: str,
    files: Sequence[Path],
    registry: Registry,
    overrides: Sequence[str],
    seeds: Sequence[int],
    *,
    out: Path | None,
    as_json: bool,
) -> None:
    """Measure the responses that a text names, and print and write the results."""
    from crowdbot.core.realism.near_robots.page import render
    from crowdbot.core.realism.near_robots.reference import read_reference, shipped

    reference = read_reference(files) if files else shipped()
    path = Path(text)
    if path.is_dir() or path.suffix.lower() == ".mcap":
        if overrides:
            raise UsageError(f"--set changes crowds that are simulated; {text} holds recorded runs")
        found = [_of_runs(path, reference)]
    else:
        found = _simulated(text, registry, reference, overrides, seeds)
    if out is not None:
        atomic_write(out, render(text, found))
    shown = [one.as_json() for one in found]
    say(
        json.dumps(shown, indent=2, ensure_ascii=False)
        if as_json
        else "\n\n".join(_text(one) for one in found)
    )
    if out is not None and not as_json:
        say(f"wrote {out}")


def _simulated(
    text: str,
    registry: Registry,
    reference: RobotReference,
    overrides: Sequence[str],
    seeds: Sequence[int],
) -> list[RobotRealism]:
    from crowdbot.core.realism.near_robots.measure import measure
    from crowdbot.core.realism.near_robots.responses import (
        KINDS,
        different_responses,
        open_responding,
        response_of_crowd,
    )
    from crowdbot.core.scenarios.library import open_spec
    from crowdbot.core.scenarios.named_crowds import names_crowd

    if text in KINDS or names_crowd(text, registry):
        crowds = {text: open_responding(text, registry, overrides)}
    else:
        crowds = different_responses(open_spec(text, registry, overrides).scenarios)
        if not crowds:
            raise InputError(f"{text}: there are no people in it")
        if len(crowds) > 1:
            seeds = seeds[:1]
    found = []
    for number, (name, crowd) in enumerate(crowds.items()):
        say(f"{number + 1} of {len(crowds)}: {name}", err=True)
        found.append(measure(name, response_of_crowd(crowd, registry), reference, seeds))
    return found


def of_recordings(
    path: Path, read: Callable[[Sequence[Path]], tuple[list[T], list[str]]]
) -> list[T]:
    """Return what is read of a recording, or of all in a folder; say how many are left out.

    Raises:
        InputError: there are none, or one cannot be read.
    """
    files = recordings_under(path) if path.is_dir() else [path]
    if not files:
        raise InputError(f"{path}: there are no recordings (.mcap) in it")
    found, without = read(files)
    if without:
        say(f"left out: {len(without)} of {len(files)} recordings; {without[0]}", err=True)
    return found


def _of_runs(path: Path, reference: RobotReference) -> RobotRealism:
    from crowdbot.core.realism.near_robots.encounters import encounters_of
    from crowdbot.core.realism.near_robots.measure import measure_encounters
    from crowdbot.core.realism.near_robots.recordings import clips_of_runs

    clips = of_recordings(path, clips_of_runs)
    return measure_encounters(str(path), encounters_of(clips), reference)


def _text(one: RobotRealism) -> str:
    from crowdbot.core.realism.near_robots.tables import (
        CELL_HEAD,
        FEATURE_HEAD,
        cell_rows,
        feature_rows,
        part_rows,
    )

    return (
        f"people: {one.line}\nindex {one.index:.2f} (0: ignore the robot, 1: recorded people)\n"
        f"{table([CELL_HEAD, *cell_rows(one)])}\n\n"
        f"{table([['similarity', 'these people', 'ignore it'], *part_rows(one)])}\n\n"
        f"{table([FEATURE_HEAD, *feature_rows(one)])}"
    )
