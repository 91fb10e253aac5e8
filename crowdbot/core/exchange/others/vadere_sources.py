"""Sources of Vadere as streams of people."""

from __future__ import annotations

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.others.shapes import area_of
from crowdbot.core.exchange.others.vadere_shapes import read_area
from crowdbot.core.exchange.others.vadere_topography import Topography, take_ids, way_of
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, number
from crowdbot.core.exchange.scene import Data, free_name

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
        SpecError: E402, a value cannot be.
    """
    report, scene = into.report, into.scene
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
    take_ids(item)
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


def _newer(item: Item, name: str, usual: float) -> float:
    part = item.find(name)
    return part.number() if part else usual


def _when(item: Item, count: int, fields: Data, report: Report) -> Data:
    """Return ``count`` for people who are there at once, else ``arrivals``."""
    begin = fields.get("begin", _newer(item, "constraintsTimeStart", 0.0))
    ends = item.find("endTime")
    end = ends.number() if ends else _newer(item, "constraintsTimeEnd", begin)
    if end <= begin:
        for part in _distribution(item):
            part.take_all()
            report.carried(part, "(people come in once)")
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
    wholes = _distribution(item)
    parts = [part for whole in wholes for part in whole.walk()]
    values = [part.number(1e-6) for part in parts if isinstance(part.value, int | float)]
    text = " ".join(part.text().lower() for part in parts if isinstance(part.value, str))
    for part in wholes:
        note = "arrivals with the same mean time between them, single persons"
        report.interpreted(part, "crowd.streams.arrivals", note)
        part.take_all()
    return (values[0] if values else 1.0), "exponential" not in text and "poisson" not in text


def _distribution(item: Item) -> list[Item]:
    """Return the parts that say when people come in."""
    names = ("interSpawnTimeDistribution", "distribution", "distributionParameters")
    return [part for name in names if (part := item.find(name)) is not None]


def _groups(item: Item) -> list[Data]:
    listed = item.find("groupSizeDistribution")
    shares = [part.number(0.0) for part in listed.every()] if listed else []
    if sum(shares[1:]) <= 0.0:
        return []
    return [{"size": k + 1, "frequency": f} for k, f in enumerate(shares) if f > 0.0]
