"""``crowdbot calibrate``: fit the parameters of a crowd to recorded people."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.plugin_table import table
from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option, switch
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from crowdbot.core.realism.calibrate import Fit, Generation
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.scenario.crowd import Crowd

_PLACES = ("speed", "body", "policy", "costs", "steering")


def calibrate(
    crowd: Annotated[
        str,
        typer.Argument(
            metavar="POLICY",
            help="A named crowd, a part, or a kind of policy; with --robot also a kind of "
            "response.",
        ),
    ],
    reference: shared.OwnRecordings = None,
    homography: shared.PixelsToMetres = None,
    frame_rate: shared.FrameRate = None,
    fit: Annotated[
        list[str] | None,
        option("KEY=LOW..HIGH", "Fit this number, SI units; default: all of them."),
    ] = None,
    robot: Annotated[
        bool, switch("--robot", "Fit the response to robots to people near robots.")
    ] = False,
    overrides: Annotated[
        list[str] | None,
        option("KEY=VALUE", "Set a value of the crowd before the fit; repeatable.", "--set"),
    ] = None,
    generations: Annotated[int, typer.Option(min=1, metavar="N", help="Steps of the fit.")] = 40,
    population: Annotated[
        int,
        typer.Option(
            min=0, metavar="N", help="Crowds tried in each step; 0: 4 + 3 ln(fitted numbers)."
        ),
    ] = 0,
    seed: Annotated[
        int, typer.Option(min=1, help="Seed of the fit; equal seeds give equal fits.")
    ] = 1,
    jobs: shared.Jobs = 0,
    out: Annotated[Path, option("FILE", "File to write, .yaml; its log is beside it.")] = Path(
        "fitted.yaml"
    ),
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Fit a crowd to recorded people and write it as a part; resumes an interrupted fit.

    Examples: crowdbot calibrate power_law --fit costs.avoid.k=0.2..4 --generations 20 --jobs 2

        crowdbot calibrate giving_way --robot --fit clearance=0.1..0.4 --generations 5
    """
    from crowdbot.cli.shared.campaign_run import worker_count
    from crowdbot.cli.shared.robot_realism import of_people
    from crowdbot.core.realism.calibrate import FitTask
    from crowdbot.core.realism.calibrate import fit as run
    from crowdbot.core.realism.near_robots.calibrate import RobotFitTask
    from crowdbot.core.realism.parameters import parameters_of

    shared.check_ending(out, ".yaml", ".yml")
    registry = shared.installed(plugin, no_plugins)
    scale = of_people(homography, frame_rate, reference, robot=robot)
    plain: dict[str, Any] = {
        "crowd": str(Path(crowd).resolve()) if Path(crowd).is_file() else crowd,
        "overrides": tuple(overrides or ()),
        "plugins": tuple(str(p.resolve()) for p in plugin or ()),
        "allowed": () if no_plugins else None,
        "files": tuple(str(f.resolve()) for f in reference or ()),
    }
    task = RobotFitTask(**plain) if robot else FitTask(**plain, scale=scale)
    parameters = parameters_of(
        _opened(task.crowd, registry, task.overrides, robot), fit or (), robot=robot
    )
    if not parameters:
        raise InputError(f"{crowd}: it has no number to fit")
    ceiling = task.ceiling  # reads the files before simulating
    say(f"{len(parameters)} numbers, recorded people reach {ceiling:.3f}", err=True)
    found = run(
        task, parameters, out.with_suffix(".fit.jsonl"), generations=generations,
        population=population, seed=seed, jobs=worker_count(jobs), watch=_show,
    )  # fmt: skip
    atomic_write(out, _part(task.crowd, registry, task.overrides, found, robot))
    say(json.dumps(_facts(found, out), indent=2) if as_json else _text(found, out))


def _show(step: Generation) -> None:
    best, mean = min(step.losses), sum(step.losses) / len(step.losses)
    note = ", from the log" if step.from_log else ""
    say(f"step {step.number + 1}: best loss {best:.4f}, mean {mean:.4f}{note}", err=True)


def _opened(crowd: str, registry: Registry, overrides: Sequence[str], robot: bool) -> Crowd:
    from crowdbot.core.realism.near_robots.responses import open_responding
    from crowdbot.core.scenarios.named_crowds import open_crowd

    return (open_responding if robot else open_crowd)(crowd, registry, overrides)


def _part(crowd: str, registry: Registry, overrides: Sequence[str], fit: Fit, robot: bool) -> str:
    from crowdbot.dsl.text.plain_yaml import to_yaml

    changes = [f"{key}={float(f'{value:.4g}')!r}" for key, value in fit.values.items()]
    fitted = _opened(crowd, registry, [*overrides, *changes], robot)
    places = (*_PLACES, "robot_response") if robot else _PLACES
    content = fitted.model_dump(mode="json", include=set(places), exclude_defaults=True)
    content["policy"]["kind"] = fitted.policy.kind
    for name, cost in fitted.costs.items():
        content["costs"][name]["kind"] = cost.kind
    if robot:
        content.setdefault("robot_response", {})["kind"] = fitted.robot_response.kind
    head = (
        f"# Fitted by `crowdbot calibrate {Path(crowd).stem}{' --robot' * robot}`: "
        f"{fit.held_out:.3f} beside recordings that were\n"
        f"# held out, {fit.training:.3f} beside those it was fitted to; "
        f"recorded people reach {fit.ceiling:.3f}.\n"
    )
    return head + to_yaml({"crowd": {n: content[n] for n in places if content.get(n)}})


def _facts(fit: Fit, out: Path) -> dict[str, Any]:
    return {
        "out": str(out),
        "held_out": round(fit.held_out, 4),
        "training": round(fit.training, 4),
        "ceiling": round(fit.ceiling, 4),
        "evaluations": fit.evaluations,
        "parameters": {
            key: {"value": value, "spread": fit.spread[key]} for key, value in fit.values.items()
        },
    }


def _text(fit: Fit, out: Path) -> str:
    rows = [["number", "value", "spread"]]
    rows += [[k, f"{v:.4g}", f"{fit.spread[k]:.2g}"] for k, v in fit.values.items()]
    return (
        f"{table(rows)}\n\nheld out {fit.held_out:.3f}, training {fit.training:.3f}, "
        f"recorded people {fit.ceiling:.3f}; {fit.evaluations} crowds simulated\nwrote {out}"
    )
