"""``crowdbot realism``: compare a crowd with people recorded in corridors or near robots."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.robot_realism import of_recordings
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import InputError, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crowdbot.core.realism.measure import Realism
    from crowdbot.core.realism.reference import RealismReference
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.trajectories.data_sets.homography import VideoScale

#: With more crowds than this, only the first draw is compared.
_FEW = 4


def realism(
    crowd: Annotated[
        str,
        typer.Argument(
            metavar="POLICY|SUITE|RUNS",
            help="A named crowd, a part, the kind of a policy, a suite, or a folder of runs; with "
            "--robot also human or giving_way.",
        ),
    ],
    reference: shared.OwnRecordings = None,
    homography: shared.PixelsToMetres = None,
    frame_rate: shared.FrameRate = None,
    robot: Annotated[
        bool, switch("--robot", "Compare how people respond to a robot with people near robots.")
    ] = False,
    seeds: Annotated[
        str | None,
        typer.Option(
            metavar="1,2,3|1..5",
            help="Draws of people; default 1..16, with --robot 1..2.",
            show_default=False,
        ),
    ] = None,
    overrides: Annotated[
        list[str] | None, option("KEY=VALUE", "Set a value of the crowd; repeatable.", "--set")
    ] = None,
    out: Annotated[
        Path | None, option("FILE", "File to write, .html: page with the curves.")
    ] = None,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Compare a crowd with recorded people: an index with its parts, ceiling and floor.

    Examples: crowdbot realism calibrated --out calibrated.html

        crowdbot realism --robot giving_way
    """
    from crowdbot.cli.shared.campaign_run import read_seeds
    from crowdbot.cli.shared.robot_realism import DRAWS, of_people, robot_realism
    from crowdbot.core.realism.page import render

    shared.check_ending(out, ".html")
    scale = of_people(homography, frame_rate, reference, robot=robot)
    registry = shared.installed(plugin, no_plugins)
    if robot:
        draws = read_seeds(seeds or f"1..{DRAWS}")
        robot_realism(
            crowd, reference or [], registry, overrides or [], draws, out=out, as_json=as_json
        )
        return
    beside = _reference(reference, scale)
    path = Path(crowd)
    if path.is_dir() or path.suffix.lower() == ".mcap":
        if overrides:
            raise UsageError(
                f"--set changes crowds that are simulated; {crowd} holds recorded runs"
            )
        found = [_of_runs(path, beside)]
    else:
        found = _simulated(crowd, registry, beside, overrides or [], read_seeds(seeds or "1..16"))
    if out is not None:
        atomic_write(out, render(crowd, found))
    say(_json(found) if as_json else "\n\n".join(_text(one) for one in found))
    if out is not None and not as_json:
        say(f"wrote {out}")


def _reference(files: Sequence[Path] | None, scale: VideoScale) -> RealismReference:
    from crowdbot.core.realism.reference import read_reference, shipped

    return read_reference(files, scale) if files else shipped()


def _simulated(
    text: str,
    registry: Registry,
    beside: RealismReference,
    overrides: Sequence[str],
    seeds: Sequence[int],
) -> list[Realism]:
    """Simulate one crowd by name, or all different crowds of a suite."""
    from crowdbot.core.realism.crowds import different_crowds
    from crowdbot.core.realism.measure import measure
    from crowdbot.core.realism.model import model_of
    from crowdbot.core.scenarios.library import open_spec
    from crowdbot.core.scenarios.named_crowds import names_crowd, open_crowd

    if names_crowd(text, registry):
        crowds = {text: open_crowd(text, registry, overrides)}
    else:
        crowds = different_crowds(open_spec(text, registry, overrides).scenarios)
        if not crowds:
            raise InputError(f"{text}: there are no people in it")
        if len(crowds) > _FEW:  # a minute for a suite too
            seeds = seeds[:1]
    return [
        measure(name, model_of(crowd, registry), beside, seeds) for name, crowd in crowds.items()
    ]


def _of_runs(path: Path, beside: RealismReference) -> Realism:
    """Measure the people in finished runs, all runs together."""
    from crowdbot.core.realism.measure import measure_met
    from crowdbot.core.realism.recordings import read_runs

    return measure_met(str(path), [of_recordings(path, read_runs)], beside)


def _json(measured: Sequence[Realism]) -> str:
    return json.dumps([one.as_json() for one in measured], indent=2, ensure_ascii=False)


def _text(one: Realism) -> str:
    from crowdbot.core.realism.tables import rows

    head = ["", "this crowd", "recorded", "no avoidance"]
    return (
        f"crowd: {one.line}\nindex {one.index:.2f} (0: no avoidance, 1: recorded people), "
        f"score {one.low:.3f} to {one.high:.3f} over draws\n"
        + (f"covers {one.coverage}\n" if one.coverage else "")
        + table([head, *rows(one)])
    )
