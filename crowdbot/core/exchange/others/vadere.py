"""Vadere: scenario JSON with its topography, sources, targets and pedestrians."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.shapes import box, middle
from crowdbot.core.exchange.others.usual import social_forces, vision
from crowdbot.core.exchange.others.vadere_shapes import add_obstacle, read_area
from crowdbot.core.exchange.others.vadere_sources import SOURCE, add_source
from crowdbot.core.exchange.others.vadere_topography import Topography, take_ids, way_of
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, positive
from crowdbot.core.exchange.scene import Data, Draft, id_of

SCENARIO = RowTable(
    "scenario",
    (
        Row("mainModel", "crowd.policy", "social forces are ours of 1995, others the usual costs"),
        Row("attributesModel", "", "parameters of Vadere's models"),
        Row("attributesSimulation", "", "people decide 16 times a second and move 128 times"),
        Row("attributesStrategy", "", "nothing changes routes while people walk"),
        Row("attributesPsychology", "", "people have no psychology layer here"),
        Row("eventInfos", "", "nothing happens to people from outside"),
        Row("stimulusInfos", "", "nothing happens to people from outside"),
    ),
)
TOPOGRAPHY = RowTable(
    "topography",
    (
        Row("obstacles", "environment.blocks"),
        Row("attributes.bounds, bounded, boundingBoxWidth", "environment.area, border"),
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


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each file.

    Raises:
        SpecError: E402, a part is missing or a value is invalid.
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
    _topography(scenario.need("topography"), Topography(scene, report))
    scene.crowd["routing"] = {"kind": "mesh"}
    report.added("crowd.routing", "Vadere's floor fields lead round obstacles", scenario.mark)
    return scene


def _topography(item: Item, into: Topography) -> None:
    report, scene = into.report, into.scene
    _bounds(item.need("attributes"), scene, report)
    for obstacle in item.entries("obstacles"):
        add_obstacle(obstacle, scene, report)
        take_ids(obstacle, report)
        report.carried(obstacle, "environment.blocks")
    for row in TOPOGRAPHY.rows[6:]:
        if (part := item.find(row.theirs)) is not None:
            empty = not part.children and part.value is None
            report.carried(part, "(empty)") if empty else report.left_out(part, row.note)
    _people(item, scene, report)
    for target in item.entries("targets"):
        _target(target, into)
    for source in item.entries("sources"):
        add_source(source, into)
    for element in item.entries("dynamicElements"):
        _element(element, into)


def _bounds(attributes: Item, scene: Draft, report: Report) -> None:
    bounds = attributes.need("bounds")
    x, y = bounds.need("x").number(), bounds.need("y").number()
    width, height = bounds.need("width").number(0.1), bounds.need("height").number(0.1)
    bounded, thick = attributes.find("bounded"), attributes.find("boundingBoxWidth")
    walled = bounded is None or bounded.truth()
    edge = thick.number(0.0) if thick and walled else 0.0
    if 2.0 * edge >= min(width, height):
        (thick or bounds).refuse("the walls at the border leave no floor")
    area = box(x + edge, x + width - edge, y + edge, y + height - edge)
    scene.environment |= {"area": area, "border": "walls" if walled else "open"}
    scene.origins["environment",] = bounds.mark
    report.carried(bounds, "environment.area")
    report.others(attributes, "the floor has no other frame")


def _people(item: Item, scene: Draft, report: Report) -> None:
    given = item.find("attributesPedestrian")
    fields = report.take(given, PEDESTRIAN) if given else {}
    scene.crowd["speed"] = {"mean": fields.get("mean", 1.34), "std": fields.get("std", 0.26)}
    body = {name: fields[name] for name in ("radius", "max_speed", "max_acceleration")
            if name in fields}  # fmt: skip
    scene.crowd["body"] = {"radius": 0.2, **body}
    if given:
        report.others(given, "a parameter of Vadere's models")


def _target(item: Item, into: Topography) -> None:
    ident = item.need("id").whole()
    if ident in into.targets:
        item.need("id").refuse(f"target {ident} is there twice")
    into.targets[ident] = read_area(item.need("shape"), into.report)
    absorber = item.find("absorber")
    given = absorber.find("enabled") if absorber else item.find("absorbing")
    into.absorbing[ident] = given is None or given.truth()
    into.report.interpreted(item, "crowd.streams.destination", TOPOGRAPHY.rows[2].note)
    take_ids(item, into.report)
    if absorber is not None and (far := absorber.find("deletionDistance")) is not None:
        into.report.left_out(far, "a goal is reached at the crowd's own distance")
    waiter = item.find("waiter")
    enabled = waiter.find("enabled") if waiter else None
    if waiter is not None and enabled is not None and not enabled.truth():
        into.report.carried(waiter, "(no one waits there)")
        into.report.others(waiter, "no one waits there")
    elif waiter is not None:
        into.report.left_out(waiter, TOPOGRAPHY.rows[3].note)
    for part in item.children:
        if not part.used:
            waits = "wait" in part.name.lower()
            note = TOPOGRAPHY.rows[3].note if waits else "goals have no such parameter"
            into.report.left_out(part, note)


def _element(item: Item, into: Topography) -> None:
    kind = item.find("type")
    if kind is not None and kind.text() != "PEDESTRIAN":
        into.report.left_out(item, "there are no cars")
        return
    position = item.need("position")
    start = [position.need("x").number(), position.need("y").number()]
    way = way_of(item, into)
    row: Data = {"x": start[0], "y": start[1],
                 "goals": [middle(into.targets[k]) for k in way] or [start],
                 "at_goal": "remove" if way and into.absorbing[way[-1]] else "stop",
                 "policy": next(iter(into.scene.policies))}  # fmt: skip
    speed = item.find("freeFlowSpeed")
    if speed is not None:
        row["speed"] = speed.number(0.01, 100.0)
    attributes = item.find("attributes")
    ident = attributes.find("id") if attributes else None
    taken = {agent["id"] for agent in into.scene.agents}
    if ident is not None and ident.whole() >= 0 and ident.whole() not in taken:
        row["id"] = ident.whole()
    row |= _group(item)
    radius = attributes.find("radius") if attributes else None
    if radius is not None:
        row["radius"] = radius.number(0.01, 10.0)
    for theirs, ours in (("maximumSpeed", "max_speed"), ("acceleration", "max_acceleration")):
        part = attributes.find(theirs) if attributes else None
        if part is not None:
            row[ours] = positive(part)
    into.scene.agent(row, item.mark)
    into.report.carried(item, "crowd.agents")
    for whole in (item, *([attributes] if attributes else [])):
        into.report.others(whole, "state of Vadere's models")


def _group(item: Item) -> Data:
    listed = item.find("groupIds")
    numbers = [part.whole() for part in listed.every()] if listed else []
    return {"group": numbers[0]} if numbers and numbers[0] >= 0 else {}


VADERE = SceneFormat(
    "vadere",
    "Vadere scenarios",
    lambda file: file.kind == "data" and "scenario" in file.tags and "crowdbot" not in file.tags,
    read,
    (SCENARIO, TOPOGRAPHY, SOURCE, PEDESTRIAN),
    "its models' parameters, stairs, waiting at targets",
)
