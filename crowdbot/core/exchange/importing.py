"""Import files of other programs: which format each is, one document, one report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.exchange.all_formats import FORMATS
from crowdbot.core.exchange.checked import check
from crowdbot.core.exchange.clearing import step_out
from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.overlaps import enter_in_turn
from crowdbot.core.exchange.recordings import RECORDINGS
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Draft, id_of
from crowdbot.core.exchange.source import IMAGES, IS_IMAGE
from crowdbot.core.exchange.ways_out import keep_ways
from crowdbot.core.exchange.write import WrittenLine, document
from crowdbot.core.registry.registry import Registry
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale
from crowdbot.core.trajectories.data_sets.people_files import people_table
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError, SpecError


@dataclass(frozen=True, slots=True)
class Imported:
    """The result of an import.

    Attributes:
        lines: the document.
        scenes: the scenes that the lines belong to.
        ids: ids of its scenarios.
        report: the outcome of each part.
        formats: titles of the formats that were read.
    """

    lines: list[WrittenLine]
    scenes: list[Draft]
    ids: list[str]
    report: Report
    formats: list[str]


def import_files(
    paths: Sequence[Path], name: str, registry: Registry, scale: VideoScale = AS_STATED
) -> Imported:
    """Read files of other programs as scenarios that validate.

    Args:
        paths: the files, in any order; those that they name are found beside them.
        name: name of the document, without its ending.
        registry: the installed components.
        scale: units of tables of recorded people.

    Raises:
        InputError: a scale is given, and no file is such a table.
        SpecError: E401 to E403, a file cannot be read, is of no known format, or does not make a
            valid scenario; with positions in the files.
    """
    report = Report()
    context = Context(report, registry, id_of(name), scale=scale)
    opened = list({id(file): file for file in map(context.open, paths)}.values())
    scenes: list[Draft] = []
    read: list[str] = []
    by_format = _by_format(opened)
    if scale and RECORDINGS.name not in by_format:
        raise InputError(
            f"{opened[0].path}: a homography and a frame rate are for {RECORDINGS.title}, and this "
            f"is {FORMATS[next(iter(by_format))].title}"
        )
    for found, files in by_format.items():
        scenes += FORMATS[found].read(files, context)
        read.append(FORMATS[found].title)
        for root in (root for file in files for root in file.roots):
            root.used = True
            report.rest(root)
    for scene in scenes:
        step_out(scene, report)
        keep_ways(scene, report)
        enter_in_turn(scene, report)
    title = f"Imported from {' and '.join(read)}"
    lines = document(scenes, context.name, title)
    return Imported(lines, scenes, check(lines, scenes, registry, opened[0].top), report, read)


def _by_format(opened: Sequence[OpenedScene]) -> dict[str, list[OpenedScene]]:
    """Return the files of each format, in the order given; companions go with their format."""
    found: dict[str, list[OpenedScene]] = {}
    for file in opened:
        form = _format_of(file)
        found.setdefault(form.name, []).append(file)
    if "trial" in found and "umans" in found:  # policies of its people
        found["trial"] += found.pop("umans")
    return found


_FLOOR = "environment: {{kind: floor_plan, file: {}}}"
_NOT_READ = (
    "is not read: export its floor as WKT or GeoJSON, for "
    "environment: {{kind: floor_plan, file: plan.wkt}}"
)
_TRACKS = (
    "recorded people are a table whose header names t (or frame), id, x and y, TrajNet++ "
    "(.ndjson), or rows of ETH, UCY, PeTrack or JuPedSim (.txt, .vsp, .sqlite)"
)
#: A tag of files other than scenes, or their ending; what reads them, or what to do.
_ELSEWHERE = (
    ("robot", "a scenario reads a robot's URDF with "
     "robots.robot.model: {{kind: urdf, file: {}}}"),
    ("sdf", "a scenario reads a robot's SDFormat with "
     "robots.robot.model: {{kind: urdf, file: {}}}; "
     "worlds of Gazebo are not read, maps made of them are"),
    ("occupied_thresh", f"a scenario reads a map of ROS with {_FLOOR}"),
    ("resets", "Arena-Rosnav's JSON is not read: its map is a floor plan, for "
     "environment: {{kind: floor_plan, file: map.yaml}}, and its pos and waypoints are x, y and "
     "goals of crowd.agents"),
    ("features", f"a scenario reads GeoJSON with {_FLOOR}"),
    (".dxf", f"a scenario reads a floor plan with {_FLOOR}"),
    *((ending, IS_IMAGE.replace("{", "{{").replace("}", "}}")) for ending in IMAGES),
    (".world", f"a world of Stage is not read: a map.yaml that names its bitmap is, with {_FLOOR}"),
    (".ifc", f"IFC {_NOT_READ}"),
    ("osm", f"OpenStreetMap's XML {_NOT_READ}"),
    *((tag, f"Menge's XML {_NOT_READ}") for tag in ("Experiment", "Project", "BFSM")),
    *((tag, f"XML of JuPedSim before 1.0 {_NOT_READ}")
      for tag in ("geometry", "JuPedSim", "routing")),
    ("floor", f"crowd:it's XML {_NOT_READ}"),
    *((tag, f"SUMO's XML {_NOT_READ}") for tag in ("routes", "net", "additional")),
    *((ending, _TRACKS) for ending in (".txt", ".tsv", ".csv")),
)  # fmt: skip


def _why_not(file: OpenedScene) -> str:
    """Return why a file cannot be read as a table of people, or ""."""
    try:
        people_table(file.path)
    except InputError as error:
        return f"as recorded people it cannot be read: {error}"
    return ""


def _format_of(file: OpenedScene) -> SceneFormat:
    for form in FORMATS.values():
        if form.fits(file):
            return form
    shown = ", ".join(sorted(file.tags)[:5]) or "plain text"
    message = f"a file of no known format (it has: {shown[:100]})"
    hint = next(
        (way.format(file.path.name) for tag, way in _ELSEWHERE
         if tag in file.tags or tag == file.path.suffix.lower()),
        f"known are {', '.join(form.title for form in FORMATS.values())}",
    )  # fmt: skip
    if hint == _TRACKS:
        hint = _why_not(file) or hint
    mark = file.roots[0].mark if file.roots else file.top
    raise SpecError([Diagnostic("E403", message, mark, hint)])
