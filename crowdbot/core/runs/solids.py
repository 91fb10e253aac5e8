"""Encode data of the replay page's 3-D view: heights, bodies, cameras."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.figures.figure import Figure, load_figure
from crowdbot.core.figures.shown import shown_figure
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.robots.look import visual_parts
from crowdbot.core.sensing.appearance_model import heights
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.component_specs import SceneLight
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")


@dataclass(frozen=True, slots=True, kw_only=True)
class SolidPeople:
    """Heights and appearances of people for the 3-D view.

    Attributes:
        height: (M,) m, or (1,) if all are alike.
        look: (M,) names of appearances; empty if all are adults.
        figures: meshes that people have in turn; empty: the plain body.
    """

    height: Array
    look: Sequence[str] = ()
    figures: Sequence[Figure] = ()


def solid_people(scenario: Scenario, people: Realisation) -> SolidPeople | None:
    """Return the bodies of a scenario's people; None without any."""
    if scenario.crowd is None or not len(people):
        return None
    seen = Appearance(
        height=np.asarray(people.height),
        leg_length=np.asarray(people.leg_length),
        phase=np.asarray(people.phase),
        look=tuple(people.look),
    )
    body = scenario.crowd.body
    return SolidPeople(
        height=heights(seen, body.height), look=seen.look, figures=_figures(body.figures)
    )


def _figures(assets: Mapping[str, Asset]) -> list[Figure]:
    """Return the figures; none, with a warning, where a file is missing."""
    try:
        return [load_figure(asset.file) for asset in assets.values()]
    except InputError as error:
        _LOG.warning("people are drawn without figures: %s", error)
        return []


def solids_of(
    parts: EnvironmentParts,
    robots: Mapping[str, tuple[RobotModel, Mapping[str, SensorInfo]]],
    people: SolidPeople | None,
) -> dict[str, Any]:
    """Return the numbers for JSON; for walls see `encode.scenery_numbers`.

    Args:
        robots: model and sensors of each, in the order of the page's robots.
        people: their bodies; None without people.
    """
    lines = ~parts.sides()
    stops = parts.stops_robot.astype(int) + 2 * parts.stops_crowd
    walls = np.column_stack([parts.walls, parts.wall_heights, stops])[lines & (stops > 0)]
    solids = zip(parts.solids, parts.solid_heights.tolist(), strict=True)
    light = {} if parts.light is None else {"light": _light(parts.light)}
    return {
        **light,
        "walls": _short(walls),
        "pillars": _short(np.column_stack([parts.pillars, parts.pillar_heights])),
        "blocks": [[_short(outline), bottom, top] for outline, (bottom, top) in solids],
        "robots": [_robot(model, sensors) for model, sensors in robots.values()],
        "people": None if people is None else _people(people),
    }


def _light(light: SceneLight) -> dict[str, Any]:
    return {
        "towards": [round(x, 4) for x in light.towards_sun],
        **light.model_dump(include={"sun", "ambient", "colour", "sky"}),
    }


def _robot(model: RobotModel, sensors: Mapping[str, SensorInfo]) -> dict[str, Any]:
    return {
        "height": model.height,
        "base": model.base_height,
        "parts": [[part.colour, _short(part.corners)] for part in visual_parts(model)],
        "cameras": [_camera(name, info) for name, info in sensors.items() if info.camera],
        "lidars": {n: info.mount[2] for n, info in sensors.items() if info.category == "lidar"},
    }


def _camera(name: str, info: SensorInfo) -> dict[str, Any]:
    """Return the place of a camera, and its vertical opening angle, rad."""
    assert info.camera is not None
    width, height = info.camera.width, info.camera.height
    return {
        "name": name,
        "mount": list(info.mount),
        "tilt": list(info.tilt),
        "opening": round(2.0 * math.atan(0.5 * height / info.camera.focal), 4),
        "aspect": round(width / height, 4),
    }


def _people(people: SolidPeople) -> dict[str, Any]:
    heights = np.round(people.height, 3)
    alike = len(heights) > 0 and bool(np.all(heights == heights[0]))
    looks = list(people.look) if any(people.look) else []
    figures = {"figures": [shown_figure(f) for f in people.figures]} if people.figures else {}
    return {"height": heights[: 1 if alike else None].tolist(), "look": looks, **figures}


def _short(rows: Array) -> list[Any]:
    found: list[Any] = np.round(rows, 3).tolist()
    return found
