"""``crowdbot export``: convert recordings for other tools."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import argument, option, switch

if TYPE_CHECKING:
    from crowdbot.core.recording.export.bag import BagOptions
    from crowdbot.core.trajectories.trajectories import Trajectories


class ExportFormat(StrEnum):
    """Output formats of ``crowdbot export``."""

    rosbag1 = "rosbag1"
    rosbag2 = "rosbag2"
    csv = "csv"
    parquet = "parquet"
    geojson = "geojson"
    trajnet = "trajnet"
    minari = "minari"
    gif = "gif"
    mp4 = "mp4"
    webm = "webm"
    png = "png"


class TreeChoice(StrEnum):
    """Source of the pose in the tf tree."""

    truth = "truth"
    odometry = "odometry"


_ENDINGS = {
    ExportFormat.rosbag1: ".bag",
    ExportFormat.geojson: ".geojson",
    ExportFormat.trajnet: ".ndjson",
    ExportFormat.minari: "-v0",
    ExportFormat.gif: ".gif",
    ExportFormat.mp4: ".mp4",
    ExportFormat.webm: ".webm",
    ExportFormat.png: ".png",
}
#: Formats that hold many runs.
_SETS = (ExportFormat.trajnet, ExportFormat.minari)


def export(
    run: Annotated[
        Path,
        argument(
            "RUN_DIR|FILE.mcap|RUNS",
            "A run, its recording, or a folder of runs for trajnet and minari.",
        ),
    ],
    to: Annotated[ExportFormat, option("FORMAT", f"One of {', '.join(ExportFormat)}.", "--to")],
    out: Annotated[
        Path | None, option("PATH", "File or folder to write; default: beside it.")
    ] = None,
    offset: Annotated[
        int, typer.Option(min=0, metavar="SECONDS", help="Bags: add this to all times.")
    ] = 0,
    tf: Annotated[
        TreeChoice, typer.Option(help="Bags: true pose, or odom to base_footprint.")
    ] = TreeChoice.truth,
    markers: Annotated[
        bool, typer.Option(help="Bags: add people and contacts as markers, one for each.")
    ] = True,
    names: Annotated[
        bool,
        switch(
            "--ros-names/--own-names",
            "Bags: names usual in ROS, such as /scan, or the recording's.",
        ),
    ] = True,
    robot: Annotated[str | None, option("NAME", "Tables: which of several robots.")] = None,
    first: Annotated[
        float | None,
        typer.Option("--from", min=0.0, metavar="SECONDS", help="Films: where to begin."),
    ] = None,
    last: Annotated[
        float | None,
        typer.Option("--until", min=0.0, metavar="SECONDS", help="Films: where to end."),
    ] = None,
    at: Annotated[
        list[float] | None,
        typer.Option(
            min=0.0,
            metavar="SECONDS",
            help="Pictures: when; repeatable, side by side; default: the decisive moment.",
        ),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option("--fps", min=1.0, max=60.0, metavar="N", help="Films: pictures a second."),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(min=0.1, max=100.0, metavar="N", help="Films: times as fast as real time."),
    ] = None,
    width: Annotated[
        int | None,
        typer.Option(min=160, max=3840, metavar="PX", help="Films, pictures: how wide."),
    ] = None,
    follow: Annotated[
        bool | None,
        typer.Option(
            "--follow/--whole",
            help="Films, pictures: follow the robot, or show all; default: all if it is small.",
            show_default=False,
        ),
    ] = None,
    dark: Annotated[bool, switch("--dark", "Films, pictures: dark colours.")] = False,
) -> None:
    """Write a recording in the format of other tools, as a film, or as pictures from above.

    Example: crowdbot export runs/challenge-2020/in-d0125-slow-c01-r02/dwa/seed-0 --to rosbag2

    A film: crowdbot export runs/tiny/a/dwa/seed-0 --to gif --from 20 --until 30

    All runs of a campaign: crowdbot export runs --to minari
    """
    from crowdbot.cli.output.film import FILMS, PICTURE, FilmOptions, write_film
    from crowdbot.cli.shared.options import check_ending
    from crowdbot.core.recording.export.bag import BagOptions
    from crowdbot.core.runs.run_directory import RECORDING
    from crowdbot.errors import InputError

    film = FilmOptions(
        first=first, last=last, at=at or (), rate=rate, speed=speed, width=width, follow=follow,
        dark=dark,
    )  # fmt: skip
    film.check(to.value)
    if to.value in (*FILMS, PICTURE):
        check_ending(out, f".{to.value}")
    if to in _SETS and run.is_dir():
        target = out or _target(run, to)
        _data_set(to, run, target, robot)
        say(str(target))
        return
    recording = run / RECORDING if run.is_dir() else run
    if to is ExportFormat.minari:
        raise InputError(f"{run}: minari takes a run directory or a folder of runs")
    if not recording.is_file():
        raise InputError(f"{run}: no such run directory or recording")
    target = out or _target(run, to)
    _check_new(target)
    write: Callable[[Path], None]
    if to.value in (*FILMS, PICTURE):
        write = partial(write_film, to.value, recording, options=film)
    elif to in (ExportFormat.rosbag1, ExportFormat.rosbag2):
        bag = BagOptions(
            offset=offset * 10**9, tree=tf.value, ros_names=names, markers=markers,
            description=_description(run) if run.is_dir() else None,
        )  # fmt: skip
        write = partial(_bag, to, recording, options=bag, run=run)
    else:
        write = partial(_tables, to, recording, robot=robot)
    _whole(target, write)
    say(str(target))


def _check_new(target: Path) -> None:
    from crowdbot.errors import InputError

    if target.exists():
        raise InputError(f"{target}: exists already; it is not written over")


def _data_set(to: ExportFormat, folder: Path, target: Path, robot: str | None) -> None:
    """Write all runs of a folder as one data set."""
    from crowdbot.cli.shared.options import installed
    from crowdbot.core.recording.export.tables import trajnet
    from crowdbot.core.runs.run_directory import runs_under
    from crowdbot.errors import InputError, UsageError
    from crowdbot.rl.minari_file import write_minari

    _check_new(target)
    runs = runs_under(folder)
    if not runs:
        raise InputError(f"{folder}: no run in it has a recording")
    if to is ExportFormat.trajnet:
        _whole(target, lambda aside: _write(aside, trajnet(_scenes(runs, robot))))
        return
    if robot is not None:
        raise UsageError("--robot has no meaning for --to minari")
    _whole(target, lambda aside: write_minari(runs, aside, installed(None)))


def _scenes(runs: Sequence[Path], robot: str | None) -> Iterator[tuple[Trajectories, str]]:
    """Yield the trajectories and the scenario id of each run directory."""
    from crowdbot.core.recording.recording import Recording
    from crowdbot.core.runs.run_directory import RECORDING

    for run in runs:
        with Recording(run / RECORDING) as opened:
            yield opened.trajectories(robot), opened.header.scenario


def _write(out: Path, text: str) -> None:
    out.write_text(text, encoding="utf-8")


def _target(run: Path, to: ExportFormat) -> Path:
    """Return the output path beside the recording, named by the format."""
    stem = run.resolve().with_suffix("") if run.is_file() else run.resolve()
    return stem.with_name(f"{stem.name}-{to.value}{_ENDINGS.get(to, '')}")


def _whole(target: Path, write: Callable[[Path], None]) -> None:
    """Write a file or folder under a temporary name, then rename it."""
    from crowdbot.errors import InputError

    folder = target.with_name(f".{target.name}.part")
    try:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        write(folder / target.name)  # files in it use its name
        (folder / target.name).rename(target)
    except OSError as error:
        raise InputError(f"{target}: cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _bag(to: ExportFormat, recording: Path, out: Path, options: BagOptions, run: Path) -> None:
    from crowdbot.core.recording.export.bag import write_ros1, write_ros2
    from crowdbot.core.recording.recording import Recording
    from crowdbot.core.runs import run_directory as files
    from crowdbot.errors import InputError

    with Recording(recording) as opened:
        names = opened.robots
    if names:
        raise InputError(
            f"{recording}: bags are made of runs of one robot, not of {', '.join(names)}; the "
            "recording itself is a ROS 2 one, which 'ros2 bag play -s mcap' plays"
        )

    if to is ExportFormat.rosbag1:
        write_ros1(recording, out, options)
        return
    write_ros2(recording, out, options)
    if run.is_dir():
        for name in (files.RECORD, files.SCENARIO, files.SCORES):
            if (run / name).is_file():
                shutil.copyfile(run / name, out / name)


def _tables(to: ExportFormat, recording: Path, out: Path, robot: str | None) -> None:
    from crowdbot.core.recording.export import tables
    from crowdbot.core.recording.recording import Recording

    with Recording(recording) as opened:
        run = opened.trajectories(robot)
    if to is ExportFormat.geojson:
        out.write_text(tables.geojson(run), encoding="utf-8")
    elif to is ExportFormat.trajnet:
        scenes = [(run, opened.header.scenario)]
        out.write_text(tables.trajnet(scenes), encoding="utf-8")
    elif to is ExportFormat.csv:
        out.mkdir()
        tables.write_csv(run, out)
    else:
        _need_pyarrow()
        out.mkdir()
        tables.write_parquet(run, out)


def _need_pyarrow() -> None:
    from crowdbot.cli.serving.serve_options import needs

    needs("analysis", "pyarrow")


def _description(run: Path) -> str | None:
    """Return the robot's URDF; None if its scenario names a plugin that is not installed."""
    from crowdbot.cli.shared.options import installed
    from crowdbot.core.robots.build import build_model
    from crowdbot.core.robots.task import sensor_infos
    from crowdbot.core.robots.urdf_export import to_urdf
    from crowdbot.core.runs.run_directory import SCENARIO
    from crowdbot.core.scenarios.library import open_spec
    from crowdbot.errors import CrowdbotError

    if not (run / SCENARIO).is_file():
        return None
    try:
        registry = installed(None)
        scenario = open_spec(str(run / SCENARIO), registry).scenarios[0]
        ((name, robot),) = scenario.robots.items()
        sensors = sensor_infos(registry, scenario, name)
        return to_urdf(build_model(registry, robot.model), sensors, name)
    except CrowdbotError as error:
        say(f"warning: /robot_description is left out: {error}", err=True)
        return None
    except ValueError:  # several robots, or none
        return None
