"""JuPedSim: walkable areas as WKT, and scenarios with exits, distributions and journeys."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.shapes import area_of, middle, pairs, rectangle_in, size
from crowdbot.core.exchange.others.usual import social_forces, vision
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Data, Draft, free_name, id_of, name_of
from crowdbot.core.geometry.valid_shape import valid_shape
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.errors import SpecError

SCENARIO = RowTable(
    "scenario",
    (
        Row("walkable_area_wkt, geometry_wkt, or a WKT file beside it", "environment.wkt"),
        Row("exits", "crowd.streams.destination", "a rectangle within their outline"),
        Row("distributions", "crowd.streams", "a rectangle within their outline"),
        Row("distributions.parameters.number", "crowd.streams.count"),
        Row("distributions.parameters.radius", "crowd.streams.body.radius"),
        Row("distributions.parameters.v0", "crowd.streams.speed"),
        Row("distributions.parameters.use_flow_spawning", "crowd.streams.arrivals"),
        Row("checkpoints", "crowd.streams.via", "people pass them and do not wait"),
        Row("journeys, journeys_v2, journey_weights", "crowd.streams",
            "one stream for each journey of a distribution, by its weight"),
        Row("model_type", "crowd.policy",
            "social forces are ours of 1995, others the usual costs; policy kind jupedsim is the "
            "library itself"),
        Row("seed, baseSeed", "crowd.seed.root"),
        Row("zones", "", "speeds do not depend on the place"),
        Row("transitions, waypoint_routing", "", "journeys say the way"),
        Row("obstacles", "environment.wkt", "cut out of the walkable area"),
        Row("simulationParams", "", "parameters of JuPedSim's models"),
    ),
)  # fmt: skip
_WKT = ("POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION")
_MODEL = "the model's own parameters have no place here"


#: Parts that are left out -> their row.
_LEFT_OUT = {"zones": 11, "transitions": 12, "waypoint_routing": 12, "routing": 12}


@dataclass(slots=True)
class _Places:
    """Exits and checkpoints by their names, and the walkable area as a shape."""

    exits: dict[str, Data] = field(default_factory=dict)
    checkpoints: dict[str, Data] = field(default_factory=dict)
    floor: Any = None

    def nearest_exit(self, area: Data) -> str:
        x, y = middle(area)
        return min(self.exits, key=lambda name: math.dist(middle(self.exits[name]), (x, y)))


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each scenario, or for each WKT where there is none.

    Raises:
        SpecError: E401 or E402, the geometry is missing or a value is invalid.
    """
    texts = [file for file in files if file.kind == "text"]
    decks = [file for file in files if file.kind == "data"]
    if not decks:
        return [_bare(file, context.report) for file in texts]
    return [_scene(file, texts, context.report) for file in decks]


def _geometry(text: str, mark: Mark, scene: Draft) -> Any:
    from shapely import GEOSException, from_wkt  # type: ignore[import-untyped,unused-ignore]

    try:
        with warnings.catch_warnings():  # of coordinates that are not numbers, refused below
            warnings.simplefilter("ignore", RuntimeWarning)
            shape = from_wkt(text)
    except (GEOSException, ValueError) as error:
        message = f"not well-known text: {str(error)[:200]}"
        raise SpecError([Diagnostic("E401", message, mark)]) from None
    if not math.isfinite(shape.length) or not all(map(math.isfinite, shape.bounds)):
        raise SpecError([Diagnostic("E402", "a coordinate is not a finite number", mark)])
    if shape.is_empty or not shape.area > 0.0:
        raise SpecError([Diagnostic("E402", "the walkable area has no area", mark)])
    scene.environment = {"kind": "floor_plan", "wkt": " ".join(text.split())}
    scene.origins["environment",] = mark
    return valid_shape(shape).buffer(0)  # polygons only


def _bare(file: OpenedScene, report: Report) -> Draft:
    """Return a WKT floor with two people who walk back and forth, since WKT describes no people."""
    from shapely import maximum_inscribed_circle  # type: ignore[import-untyped,unused-ignore]

    scene = Draft(id_of(file.path.stem))
    scene.notes.append(f"Imported from WKT: {file.path.name}.")
    shape = _geometry(file.text, file.top, scene)
    whole = Item("WKT", file.top)
    report.carried(whole, "environment.wkt")
    parts = sorted(getattr(shape, "geoms", [shape]), key=lambda part: -part.area)
    circle = maximum_inscribed_circle(parts[0], tolerance=0.05)
    (x, y), reach = circle.coords[0], 0.5 * circle.length
    policy = scene.policy(vision(), "usual", file.top)
    for sign in (-1.0, 1.0):
        row = {"x": x + sign * reach, "y": y, "speed": 1.3, "radius": min(0.25, 0.4 * reach),
               "goals": [[x - sign * reach, y], [x + sign * reach, y]], "at_goal": "loop",
               "policy": policy}  # fmt: skip
        scene.agent(row, file.top, "not in the file, which has a floor only")
    report.added("crowd.agents", "two people, since WKT has a floor only", file.top)
    return scene


def _scene(file: OpenedScene, texts: Sequence[OpenedScene], report: Report) -> Draft:
    root, scene = _root(file.roots[0]), Draft(id_of(file.path.stem))
    scene.notes.append(f"Imported from JuPedSim: {file.path.name}.")
    floor = _without_obstacles(root, _floor(root, file, texts, scene, report), scene, report)
    _model(root, scene, report)
    places = _Places(floor=floor)
    for name, into in (("exits", places.exits), ("checkpoints", places.checkpoints)):
        for item in root.entries(name):
            into[item.name], how = rectangle_in(pairs(item.need("coordinates")), floor)
            row = SCENARIO.rows[1 if name == "exits" else 7]
            report.interpreted(item, row.ours, how or row.note)
            report.others(item, "exits and checkpoints have no such parameter")
    journeys = _journeys(root, places, report)
    for item in root.entries("distributions"):
        _distribution(item, places, journeys, scene, report)
    for name, at in _LEFT_OUT.items():
        if (left := root.find(name)) is not None:
            if left.children or left.value is not None:
                report.left_out(left, SCENARIO.rows[at].note)
            else:
                report.carried(left, "(empty)")
    for item in root.children:
        if not item.used and (item.name.startswith("_") or item.name in ("project_version",)):
            report.left_out(item, "for people and for other programs")
    return scene


def _root(top: Item) -> Item:
    """Return the scenario's root: in a message to a running program it is the part ``config``."""
    inside = top.find("config") if any(c.name == "geometry_wkt" for c in top.children) else None
    return inside if inside is not None and _is_scenario(inside) else top


def _is_scenario(item: Item) -> bool:
    return {"distributions", "exits"} <= {part.name for part in item.children}


def _floor(
    root: Item, file: OpenedScene, texts: Sequence[OpenedScene], scene: Draft, report: Report
) -> Any:
    inside = root.find("walkable_area_wkt") or (root.parent or root).find("geometry_wkt")
    if inside is not None:
        report.carried(inside, "environment.wkt")
        return _geometry(inside.text(), inside.mark, scene)
    beside = [t for t in texts if t.path.stem == file.path.stem] or list(texts)
    if beside:
        report.carried(Item("WKT", beside[0].top), "environment.wkt")
        return _geometry(beside[0].text, beside[0].top, scene)
    from crowdbot.core.exchange.source import source_of

    found = sorted(file.path.parent.glob("*.wkt"))
    if len(found) != 1:
        root.refuse("no walkable area: give its WKT file, too, or put one beside this file")
    source, text = source_of(found[0])
    report.carried(Item("WKT", Mark(source)), "environment.wkt")
    return _geometry(text, Mark(source), scene)


def _without_obstacles(root: Item, floor: Any, scene: Draft, report: Report) -> Any:
    """Return the walkable area less the obstacles that are given beside it."""
    from shapely import Polygon, to_wkt  # type: ignore[import-untyped,unused-ignore]

    for item in root.entries("obstacles"):
        shape = valid_shape(Polygon(pairs(item.need("coordinates"))))
        if shape.intersection(floor).area > 0.0:
            floor = floor.difference(shape)
            scene.environment["wkt"] = to_wkt(floor, rounding_precision=9)
        if not floor.area > 0.0:
            item.refuse("nothing of the walkable area is left beside the obstacles")
        report.interpreted(item, "environment.wkt", SCENARIO.rows[13].note)
        report.others(item, "obstacles have no such parameter")
    return floor


def _model(root: Item, scene: Draft, report: Report) -> None:
    kinds = [item for item in root.walk() if item.name == "model_type"]
    social = any("social" in item.text().lower() for item in kinds)
    at = kinds[0] if kinds else root
    scene.policy(social_forces() if social else vision(), "usual", at.mark)
    for item in kinds:
        report.interpreted(item, "crowd.policy", SCENARIO.rows[9].note)
    seeds = [item for item in root.walk() if item.name in ("seed", "baseSeed")]
    if seeds:
        scene.crowd["seed"] = {"root": seeds[0].whole(0, 10**9)}
        for item in seeds:
            if item.number() == seeds[0].number():
                report.carried(item, "crowd.seed.root")
            else:
                report.left_out(item, "the first seed in the file counts")
    config = root.find("config")
    for item in config.walk() if config else ():
        if item.children and item.name in ("simulation_settings", "simulationParams"):
            item.used = True
    for item in list(config.walk()) if config else ():
        if not item.used:
            report.left_out(item, _MODEL)
    if (params := root.find("model_parameters")) is not None:
        report.left_out(params, _MODEL)
    scene.crowd["routing"] = {"kind": "mesh"}
    report.added("crowd.routing", "JuPedSim's people find their way round walls", root.mark)


def _journeys(root: Item, places: _Places, report: Report) -> dict[str, list[str]]:
    """Return the names of the stages of each journey, in turn."""
    journeys: dict[str, list[str]] = {}
    starts = {item.name for item in root.entries("distributions")}
    known = {*places.exits, *places.checkpoints, *starts}
    for listed, stages in (("journeys_v2", "sequence"), ("journeys", "stages")):
        for item in root.entries(listed):
            ident = item.need("id").text()
            names = item.find(stages)
            journeys[ident] = [part.text() for part in names.every()] if names else []
            report.interpreted(item, "crowd.streams", SCENARIO.rows[8].note)
            for part in names.every() if names else ():
                if part.text() not in known:
                    report.left_out(part, f"no exit or checkpoint '{part.text()[:60]}'")
            report.others(item, "journeys have no such parameter")
    return journeys


def _distribution(
    item: Item, places: _Places, journeys: dict[str, list[str]], scene: Draft, report: Report
) -> None:
    area, how = rectangle_in(pairs(item.need("coordinates")), places.floor)
    report.interpreted(item, "crowd.streams", how or "people start within it")
    parameters = item.find("parameters") or item
    count = _count(parameters, area)
    ways = _ways(item, area, places, journeys)
    if not ways:
        item.refuse("no exit for these people: there is no journey and no exit")
    total = sum(weight for _, weight in ways)
    left = count
    for number, (way, weight) in enumerate(ways):
        last = number == len(ways) - 1
        share = left if last else min(left, round(count * weight / total))
        left -= share
        if share > 0:
            _stream(item, parameters, area, way, share, scene)
    for whole in (parameters, item):
        report.others(whole, "streams have no such parameter")


def _count(parameters: Item, area: Data) -> int:
    number, mode = parameters.find("number"), parameters.find("distribution_mode")
    share = parameters.find("percentage")
    by_share = mode is not None and mode.text() in ("by_percentage", "fill_area", "until_full")
    if by_share or (number is None and share is not None):
        percent = share.number(0.0, 100.0) if share and share.value is not None else 50.0
        radius = parameters.find("radius")
        body = radius.number(0.01, 10.0) if radius else 0.2
        return int(size(area) / (math.pi * body**2) / 2.0 * percent / 100.0)
    return number.whole(0, 100_000) if number else 10


def _ways(
    item: Item, area: Data, places: _Places, journeys: dict[str, list[str]]
) -> list[tuple[list[Data], float]]:
    """Return the routes of a distribution, with weights: rectangles in turn, the last an exit."""
    known = {**places.checkpoints, **places.exits}
    weights = item.find("journey_weights")
    chosen: list[tuple[list[str], float]] = []
    for part in weights.every() if weights else []:
        ident, share = part.need("journey_id"), part.find("weight")
        if ident.text() not in journeys:
            ident.refuse(f"no journey '{ident.text()[:60]}'", list(journeys))
        chosen.append((journeys[ident.text()], share.number(0.0) if share else 1.0))
    if not chosen:
        chosen = [(stages, 1.0) for stages in journeys.values() if item.name in stages]
    ways: list[tuple[list[Data], float]] = []
    for stages, weight in chosen:
        way = [known[name] for name in stages if name in known]
        ends = [name for name in stages if name in places.exits]
        if not ends and places.exits:
            way.append(places.exits[places.nearest_exit(area)])
        if way and weight > 0.0:
            ways.append((way, weight))
    if not ways and places.exits:
        ways = [([places.exits[places.nearest_exit(area)]], 1.0)]
    return ways


def _stream(
    item: Item, parameters: Item, area: Data, way: list[Data], count: int, scene: Draft
) -> None:
    radius, speed = parameters.find("radius"), parameters.find("v0")
    spread = parameters.find("v0_std")
    stream: Data = {
        "kind": "through", "origin": area_of(area), "destination": area_of(way[-1]),
        "at_destination": "leave",
        "body": {"radius": radius.number(0.01, 10.0) if radius else 0.2},
        "speed": {"mean": speed.number(0.01, 20.0) if speed else 1.3,
                  "std": spread.number(0.0) if spread and spread.value is not None else 0.0},
    }  # fmt: skip
    if way[:-1]:
        stream["via"] = [area_of(stage) for stage in way[:-1]]
    flow = parameters.find("use_flow_spawning")
    if flow is not None and flow.truth():
        begin, end = parameters.find("flow_start_time"), parameters.find("flow_end_time")
        start = begin.number(0.0) if begin else 0.0
        until = end.number(0.0) if end else start + 10.0
        if until <= start:
            (end or parameters).refuse("flow_end_time is not after flow_start_time")
        stream["arrivals"] = {"every": (until - start) / count, "begin": start, "until": until}
    else:
        stream["count"] = count
    streams = scene.crowd.setdefault("streams", {})
    name = free_name(name_of(item.name), streams)
    streams[name] = stream
    scene.origins["crowd", "streams", name] = item.mark


def _fits(file: OpenedScene) -> bool:
    if file.kind == "data":
        return _is_scenario(_root(file.roots[0]))
    return file.kind == "text" and file.text.lstrip().upper().startswith(_WKT)


JUPEDSIM = SceneFormat(
    "jupedsim",
    "JuPedSim scenarios and WKT",
    _fits,
    read,
    (SCENARIO,),
    "its models' parameters, zones of other speed, waiting at checkpoints",
)
