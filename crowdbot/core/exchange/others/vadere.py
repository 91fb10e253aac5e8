"""Vadere: scenario JSON with its topography, sources, targets and pedestrians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.shapes import area_of, box, middle, rectangle_in
from crowdbot.core.exchange.others.usual import social_forces, vision
from crowdbot.core.exchange.polygons import add_polygon
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, number, positive
from crowdbot.core.exchange.scene import Data, Draft, free_name, id_of

SCENARIO = RowTable(
    "scenario",
    (
        Row("mainModel", "crowd.policy", "social forces are ours of 1995, others the usual costs"),
        Row("attributesModel", "", "parameters of Vadere's models"),
        Row("attributesSimulation", "", "people decide 16 times a second and move 128 times"),
        Row("attributesPsychology", "", "people have no psychology layer here"),
        Row("eventInfos", "", "nothing happens to people from outside"),
        Row("stimulusInfos", "", "nothing happens to people from outside"),
    ),
)
TOPOGRAPHY = RowTable(
    "topography",
    (
        Row("obstacles", "environment.blocks"),
        Row("attributes.bounds, bounded", "environment.area, border"),
        Row("targets", "crowd.streams.destination", "a rectangle within their shape"),
        Row("targets.waitingTime", "", "people do not wait on their way"),
        Row("sources", "crowd.streams", "a rectangle within their shape"),
        Row("dynamicElements", "crowd.agents"),
        Row("measurementAreas", "", "metrics are those of crowdbot"),
        Row("stairs", "", "the floor is flat"),
        Row("targetChangers", "", "people keep their goals"),
        Row("absorbingAreas", "", "people leave at their goals only"),
        Row("aerosolClouds", "", "there is no air"),
        Row("droplets", "", "there is no air"),
        Row("teleporter", "", "places are where they are"),
        Row("attributesCar", "", "there are no cars"),
    ),
)
PEDESTRIAN = RowTable(
    "attributesPedestrian",
    (
        Row("radius", "crowd.body.radius", read=lambda item: item.number(0.01, 10.0)),
        Row("speedDistributionMean", "crowd.speed.mean", read=positive),
        Row("speedDistributionStandardDeviation", "crowd.speed.std",
            read=lambda item: item.number(0.0)),
        Row("acceleration", "crowd.body.max_acceleration", read=positive),
        Row("maximumSpeed", "crowd.body.max_speed", read=positive),
    ),
)  # fmt: skip
SOURCE = RowTable(
    "source",
    (
        Row("spawnNumber", "crowd.streams.count", "people at a time; with interSpawnTime arrivals",
            read=lambda item: item.whole(0, 100_000)),
        Row("startTime", "crowd.streams.arrivals.begin", read=lambda item: item.number(0.0)),
        Row("endTime", "crowd.streams.arrivals.until", read=number),
        Row("maxSpawnNumberTotal", "crowd.streams.arrivals.until",
            read=lambda item: item.whole(-1, 10**9)),
    ),
)  # fmt: skip
_FORMS = ("RECTANGLE", "POLYGON")


@dataclass(slots=True)
class _Topography:
    """Targets by id, and the scene that is filled."""

    scene: Draft
    report: Report
    targets: dict[int, Data] = field(default_factory=dict)
    absorbing: dict[int, bool] = field(default_factory=dict)


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each file.

    Raises:
        SpecError: E402, a part is missing or a value cannot be.
    """
    return [_scene(file, context.report) for file in files]


def _scene(file: OpenedScene, report: Report) -> Draft:
    root = file.roots[0]
    name = root.find("name")
    scene = Draft(id_of(name.text() if name else file.path.stem))
    scene.notes.append(f"Imported from Vadere: {file.path.name}.")
    for part, note in (("description", "for people"), ("release", "the version of Vadere"),
                       ("processWriters", "metrics are those of crowdbot"),
                       ("commithash", "the version of Vadere")):  # fmt: skip
        if (item := root.find(part)) is not None:
            report.left_out(item, note)
    scenario = root.need("scenario")
    model = scenario.find("mainModel")
    social = model is not None and "social" in model.text().lower()
    scene.policy(social_forces() if social else vision(), "usual", (model or scenario).mark)
    if model is not None:
        report.interpreted(model, "crowd.policy", SCENARIO.rows[0].note)
    for row in SCENARIO.rows[1:]:
        if (item := scenario.find(row.theirs)) is not None:
            report.left_out(item, row.note)
    _topography(scenario.need("topography"), _Topography(scene, report))
    scene.crowd["routing"] = {"kind": "mesh"}
    report.added("crowd.routing", "Vadere's floor fields lead round obstacles", scenario.mark)
    return scene


def _topography(item: Item, into: _Topography) -> None:
    report, scene = into.report, into.scene
    _bounds(item.need("attributes"), scene, report)
    for obstacle in _entries(item, "obstacles"):
        corners, _ = _shape(obstacle.need("shape"), report)
        add_polygon(scene, report, obstacle, corners)
        _ids(obstacle)
        report.carried(obstacle, "environment.blocks")
    for row in TOPOGRAPHY.rows[6:]:
        if (part := item.find(row.theirs)) is not None:
            empty = not part.children and part.value is None
            report.carried(part, "(empty)") if empty else report.left_out(part, row.note)
    _people(item, scene, report)
    for target in _entries(item, "targets"):
        _target(target, into)
    for source in _entries(item, "sources"):
        _source(source, into)
    for element in _entries(item, "dynamicElements"):
        _element(element, into)


def _entries(item: Item, name: str) -> list[Item]:
    listed = item.find(name)
    return listed.every() if listed else []


def _ids(item: Item) -> None:
    for name in ("id", "visible", "reference"):
        if (part := item.find(name)) is not None:
            part.take_all()


def _bounds(attributes: Item, scene: Draft, report: Report) -> None:
    bounds = attributes.need("bounds")
    x, y = bounds.need("x").number(), bounds.need("y").number()
    width, height = bounds.need("width").number(0.1), bounds.need("height").number(0.1)
    scene.environment["area"] = box(x, x + width, y, y + height)
    bounded = attributes.find("bounded")
    scene.environment["border"] = "walls" if bounded is None or bounded.truth() else "open"
    scene.origins["environment",] = bounds.mark
    report.carried(bounds, "environment.area")
    for part in attributes.children:
        if not part.used:
            report.left_out(part, "walls at the border have no width, maps no other frame")


def _shape(item: Item, report: Report) -> tuple[list[list[float]], Data]:
    """Return corners of a shape, and a rectangle within it."""
    kind = item.need("type").text()
    if kind not in _FORMS:
        item.need("type").refuse(f"no shape '{kind[:40]}'", _FORMS)
    if kind == "RECTANGLE":
        x, y = item.need("x").number(), item.need("y").number()
        w, h = item.need("width").number(1e-6), item.need("height").number(1e-6)
        return [[x, y], [x + w, y], [x + w, y + h], [x, y + h]], box(x, x + w, y, y + h)
    points = [[p.need("x").number(), p.need("y").number()] for p in item.need("points").every()]
    if len(points) < 3:
        item.refuse("a polygon of fewer than 3 points")
    found, how = rectangle_in(points)
    if how:
        report.interpreted(item, "area", f"where an area is needed: {how}")
    return points, found


def _people(item: Item, scene: Draft, report: Report) -> None:
    given = item.find("attributesPedestrian")
    fields = report.take(given, PEDESTRIAN) if given else {}
    scene.crowd["speed"] = {"mean": fields.get("mean", 1.34), "std": fields.get("std", 0.26)}
    body = {name: fields[name] for name in ("radius", "max_speed", "max_acceleration")
            if name in fields}  # fmt: skip
    scene.crowd["body"] = {"radius": 0.2, **body}
    for part in given.children if given else []:
        if not part.used:
            report.left_out(part, "a parameter of Vadere's models")


def _target(item: Item, into: _Topography) -> None:
    ident = item.need("id").whole()
    if ident in into.targets:
        item.need("id").refuse(f"target {ident} is there twice")
    _, into.targets[ident] = _shape(item.need("shape"), into.report)
    absorber = item.find("absorber")
    given = absorber.find("enabled") if absorber else item.find("absorbing")
    into.absorbing[ident] = given is None or given.truth()
    into.report.interpreted(item, "crowd.streams.destination", TOPOGRAPHY.rows[2].note)
    for part in item.children:
        if not part.used:
            into.report.left_out(part, TOPOGRAPHY.rows[3].note)


def _way(item: Item, into: _Topography) -> list[int]:
    listed = item.find("targetIds")
    found = []
    for part in listed.every() if listed else []:
        ident = part.whole()
        if ident not in into.targets:
            known = ", ".join(map(str, sorted(into.targets))) or "none"
            part.refuse(f"no target {ident}; there are: {known}")
        found.append(ident)
    return found


def _source(item: Item, into: _Topography) -> None:
    report, scene = into.report, into.scene
    _, area = _shape(item.need("shape"), report)
    spawner = item.find("spawner") or item
    fields = report.take(spawner, SOURCE)
    way = _way(item, into)
    count = fields.get("count", _newer(spawner, "eventElementCount", 1))
    stream: Data = {"kind": "through", "origin": area_of(area)}
    if not way:
        report.left_out(item, "people without a target", whole=False)
        return
    stream["destination"] = area_of(into.targets[way[-1]])
    if way[:-1]:
        stream["via"] = [area_of(into.targets[k]) for k in way[:-1]]
    stream |= _when(spawner, int(count), fields, report)
    stream["at_destination"] = "leave" if into.absorbing[way[-1]] else "stop"
    if groups := _groups(item):
        stream["groups"] = groups
    streams = scene.crowd.setdefault("streams", {})
    name = free_name("source", streams)
    streams[name] = stream
    scene.origins["crowd", "streams", name] = item.mark
    report.interpreted(item, "crowd.streams", TOPOGRAPHY.rows[4].note)
    for part in [*item.children, *(spawner.children if spawner is not item else [])]:
        if not part.used:
            report.left_out(part, "streams have no such parameter")


def _newer(item: Item, name: str, usual: float) -> float:
    part = item.find(name)
    return part.number() if part else usual


def _when(item: Item, count: int, fields: Data, report: Report) -> Data:
    """Return ``count`` for people who are there at once, else ``arrivals``."""
    begin = fields.get("begin", _newer(item, "constraintsTimeStart", 0.0))
    ends = item.find("endTime")
    end = ends.number() if ends else _newer(item, "constraintsTimeEnd", begin)
    if end <= begin:
        times = {} if begin <= 0.0 else {"arrivals": {"times": [begin] * min(count, 10_000)}}
        return times or {"count": count}
    mean, regular = _interval(item, report)
    every = mean / max(count, 1)
    most = item.find("maxSpawnNumberTotal") or item.find("constraintsElementsMax")
    if most is not None and most.whole() > 0:
        end = min(end, begin + most.whole() * every)
    when: Data = {"begin": begin, "until": round(end, 6)}
    return {"arrivals": when | ({"every": every} if regular else {"rate": 1.0 / every})}


def _interval(item: Item, report: Report) -> tuple[float, bool]:
    """Return the mean time between spawns, s, and True if it is regular."""
    kind = item.find("interSpawnTimeDistribution") or item.find("distribution")
    given = item.find("distributionParameters")
    parts = [part for whole in (kind, given) if whole for part in whole.walk()]
    values = [part.number(1e-6) for part in parts if isinstance(part.value, int | float)]
    text = " ".join(part.text().lower() for part in parts if isinstance(part.value, str))
    for part in filter(None, (kind, given)):
        note = "arrivals with the same mean time between them, single persons"
        report.interpreted(part, "crowd.streams.arrivals", note)
        part.take_all()
    return (values[0] if values else 1.0), "exponential" not in text and "poisson" not in text


def _groups(item: Item) -> list[Data]:
    listed = item.find("groupSizeDistribution")
    shares = [part.number(0.0) for part in listed.every()] if listed else []
    if sum(shares[1:]) <= 0.0:
        return []
    return [{"size": k + 1, "frequency": f} for k, f in enumerate(shares) if f > 0.0]


def _element(item: Item, into: _Topography) -> None:
    kind = item.find("type")
    if kind is not None and kind.text() != "PEDESTRIAN":
        into.report.left_out(item, "there are no cars")
        return
    position = item.need("position")
    start = [position.need("x").number(), position.need("y").number()]
    way = _way(item, into)
    row: Data = {"x": start[0], "y": start[1],
                 "goals": [middle(into.targets[k]) for k in way] or [start],
                 "at_goal": "remove" if way and into.absorbing[way[-1]] else "stop",
                 "policy": next(iter(into.scene.policies))}  # fmt: skip
    speed = item.find("freeFlowSpeed")
    if speed is not None:
        row["speed"] = speed.number(0.01, 100.0)
    attributes = item.find("attributes")
    radius = attributes.find("radius") if attributes else None
    if radius is not None:
        row["radius"] = radius.number(0.01, 10.0)
    into.scene.agent(row, item.mark)
    into.report.carried(item, "crowd.agents")
    for part in [*item.children, *(attributes.children if attributes else [])]:
        if not part.used:
            into.report.left_out(part, "state of Vadere's models")


VADERE = SceneFormat(
    "vadere",
    "Vadere scenarios",
    lambda file: file.kind == "data" and "scenario" in file.tags and "crowdbot" not in file.tags,
    read,
    (SCENARIO, TOPOGRAPHY, SOURCE, PEDESTRIAN),
    "its models' parameters, stairs, waiting at targets",
)
