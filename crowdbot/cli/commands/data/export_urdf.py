"""``crowdbot export-urdf``: export a robot's body and sensor frames for ROS tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import option
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.types.sensor import SensorInfo
    from crowdbot.dsl.scenario.scenario import Scenario


def export_urdf(
    robot: Annotated[
        str, typer.Argument(help="Kind of a robot; with --spec, name of a robot in a scenario.")
    ],
    spec: Annotated[
        str | None, typer.Option("--spec", help="Scenario or suite that has the robot.")
    ] = None,
    id_: Annotated[
        str | None, typer.Option("--id", help="Id in a suite; default: its first scenario.")
    ] = None,
    out: Annotated[Path | None, option("FILE", "File to write; default: standard output.")] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
) -> None:
    """Write a robot as URDF, with a frame for each sensor.

    Example: crowdbot export-urdf robot --spec challenge-2020 --out turtlebot2.urdf
    """
    from crowdbot.core.robots.build import build_model
    from crowdbot.core.robots.task import sensor_infos
    from crowdbot.core.robots.urdf_export import to_urdf
    from crowdbot.core.support.atomic_write import atomic_write

    registry = installed(plugin, no_plugins)
    sensors: Mapping[str, SensorInfo] = {}
    if spec is None:
        model = build_model(registry, registry.find("robot", robot).spec(kind=robot))
    else:
        found = _scenario(registry, robot, spec, id_)
        model = build_model(registry, found.robots[robot].model)
        sensors = sensor_infos(registry, found, robot)
    text = to_urdf(model, sensors, robot)
    if out is None:
        say(text, nl=False)
    else:
        atomic_write(out, text)
        say(str(out), err=True)


def _scenario(registry: Registry, robot: str, spec: str, id_: str | None) -> Scenario:
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.errors import UnknownNameError

    expansion = open_spec(spec, registry)
    scenario = expansion.scenarios[0] if id_ is None else pick(expansion, id_)
    if robot not in scenario.robots:
        raise UnknownNameError("robot", robot, scenario.robots)
    return scenario
