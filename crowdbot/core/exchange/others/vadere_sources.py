"""Sources of Vadere as streams of people."""

from __future__ import annotations

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.others.shapes import area_of
from crowdbot.core.exchange.others.vadere_shapes import read_area
from crowdbot.core.exchange.others.vadere_times import read_times
from crowdbot.core.exchange.others.vadere_topography import Topography, take_ids, way_of
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, number
from crowdbot.core.exchange.scene import USUAL_RADIUS, Data, free_name
from crowdbot.dsl.checks.spawns import most_points

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


def add_source(item: Item, into: Topography) -> None:
    """Add a source as a stream.

    Raises:
        SpecError: E402, a value is invalid.
    """
    report, scene = into.report, into.scene
    for holder in (item, item.find("spawner") or item):
        kind = holder.find("dynamicElementType")
        if kind is not None and kind.value is not None and kind.text() != "PEDESTRIAN":
            report.left_out(item, "there are no cars")
            return
    area = read_area(item.need("shape"), report)
    spawner = item.find("spawner") or item
    fields = report.take(spawner, SOURCE)
    way = way_of(item, into)
    count = fields.get("count", _newer(spawner, "eventElementCount", 1))
    stream: Data = {"kind": "through", "origin": area_of(area)}
    if not way:
        report.left_out(item, "its people have no target")
        return
    stream["destination"] = area_of(into.targets[way[-1]])
    if way[:-1]:
        stream["via"] = [area_of(into.targets[k]) for k in way[:-1]]
    stream |= _when(spawner, int(count), fields, report)
    _let_wait(stream, item, into)
    take_ids(item, report)
    stream["at_destination"] = "leave" if into.absorbing[way[-1]] else "stop"
    if groups := _groups(item):
        stream["groups"] = groups
    streams = scene.crowd.setdefault("streams", {})
    name = free_name("source", streams)
    streams[name] = stream
    scene.origins["crowd", "streams", name] = item.mark
    report.interpreted(item, "crowd.streams", "a rectangle within their shape")
    for part in [*item.children, *(spawner.children if spawner is not item else [])]:
        if part.used:
            continue
        if part.value is None and not part.children:
            report.carried(part, "(empty)")
        else:
            report.left_out(part, _SOURCE_NOTES.get(part.name, "streams have no such parameter"))


_RANDOM = "people here come in at free places that are drawn"
#: Parts of a source that have no field -> reason.
_SOURCE_NOTES = {
    **dict.fromkeys(("eventPositionRandom", "eventPositionGridCA", "eventPositionFreeSpace",
                     "spawnAtRandomPositions", "spawnAtGridPositionsCA", "useFreeSpaceOnly"),
                    _RANDOM),
    "type": "the class of its spawner",
    "dynamicElementType": "people are the only kind here",
}  # fmt: skip


def _let_wait(stream: Data, item: Item, into: Topography) -> None:
    """Let people without room at a source enter as soon as there is room, as in Vadere."""
    radius = into.scene.crowd.get("body", {}).get("radius", USUAL_RADIUS)
    room = most_points(tuple(stream["origin"]["size"]), radius, 2.0 * radius)
    if not 0 < room < stream.get("count", 0):
        return
    stream["arrivals"] = {"times": [0.0] * min(stream.pop("count"), 10_000)}
    note = f"there is room for {room} at once: the others enter as soon as there is more"
    into.report.interpreted(item, "crowd.streams.arrivals", note)


def _newer(item: Item, name: str, usual: float) -> float:
    part = item.find(name)
    return part.number() if part else usual


def _when(item: Item, count: int, fields: Data, report: Report) -> Data:
    """Return ``count`` for people who are present from the start, else ``arrivals``."""
    begin = fields.get("begin", _newer(item, "constraintsTimeStart", 0.0))
    ends = item.find("endTime")
    end = ends.number() if ends else _newer(item, "constraintsTimeEnd", begin)
    times = read_times(item, report)
    most = item.find("maxSpawnNumberTotal") or item.find("constraintsElementsMax")
    total = most.whole() if most is not None else -1
    if end <= begin or times.once is not None:
        at = begin if times.once is None else max(begin, times.once)
        count = min(count, total) if total > 0 else count
        return {"arrivals": {"times": [at] * min(count, 10_000)}} if at > 0.0 else {"count": count}
    every = times.mean / max(count, 1)
    if total > 0:
        end = min(end, begin + total * every)
    when: Data = {"begin": begin, "until": round(end, 6)}
    rate = {"every": every} if times.regular else {"rate": 1.0 / every}
    return {"arrivals": when | rate}


def _groups(item: Item) -> list[Data]:
    listed = item.find("groupSizeDistribution")
    shares = [part.number(0.0) for part in listed.every()] if listed else []
    if sum(shares[1:]) <= 0.0:
        return []
    return [{"size": k + 1, "frequency": f} for k, f in enumerate(shares) if f > 0.0]
