"""Maps of environments: what is written is what is read back."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from numpy.typing import NDArray

from crowdbot.cli import main
from crowdbot.core.environments.grid_map import GridMap
from crowdbot.plugin import EnvironmentParts
from crowdbot.plugins.environments.floor_plan import FloorPlanSpec
from crowdbot.plugins.environments.halls import ShedSpec
from crowdbot.plugins.environments.place_build import build
from tests.paths import ROOT

SHED = str(ROOT / "scenario_specs" / "examples" / "world_shed.yaml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The maps of the hall."""
    out = tmp_path_factory.mktemp("maps")
    assert main(["export-map", SHED, "--out", str(out)]) == 0
    return out


def _by_height(parts: EnvironmentParts) -> dict[tuple[float, float], float]:
    areas: dict[tuple[float, float], float] = {}
    for solid, (base, top) in zip(parts.solids, parts.solid_heights.tolist(), strict=True):
        areas[base, top] = areas.get((base, top), 0.0) + float(shapely.Polygon(solid).area)
    return areas


def _shed() -> EnvironmentParts:
    words = {"openings": {"door": {"side": "south", "at": 0.0, "width": 3.0}}}
    return build(ShedSpec.model_validate(words))


def test_the_geojson_gives_the_same_place(folder: Path) -> None:
    read = build(FloorPlanSpec.model_validate({"file": str(folder / "map.geojson")}))
    expected, found = _by_height(_shed()), _by_height(read)
    pillars = found.pop((0.0, 6.0))  # three of 0.3 m, as polygons; stubs beside the door
    assert pillars == pytest.approx(3 * np.pi * 0.09 + 2 * 0.1, rel=0.02)
    assert found == pytest.approx(expected, rel=1e-6)
    content = json.loads((folder / "map.geojson").read_text())
    kinds = [f["properties"]["kind"] for f in content["features"]]
    assert kinds.count("walkable") == 1
    assert kinds.count("zone") == 3
    assert kinds.count("portal") == 1


def _cells(folder: Path) -> tuple[NDArray[np.uint8], tuple[float, float], float]:
    content = (folder / "map.pgm").read_bytes()
    magic, size, most, pixels = content.split(b"\n", 3)
    width, height = map(int, size.split())
    assert (magic, most) == (b"P5", b"255")
    cells = np.frombuffer(pixels, np.uint8).reshape(height, width)[::-1]
    text = (folder / "map.yaml").read_text()
    words = dict(line.split(": ", 1) for line in text.splitlines())
    x, y, _ = json.loads(words["origin"])
    return cells, (x, y), float(words["resolution"])


@pytest.mark.parametrize(
    ("x", "y", "grey"),
    [
        (0.0, 5.0, 254),  # free
        (-10.0, -6.0, 0),  # a low wall
        (-10.0, 6.0, 0),  # a gate: the robot does not fit under it
        (0.0, 0.0, 0),  # a pillar
        (-20.0, 0.0, 0),  # the outer wall
        (0.0, -12.0, 0),  # the door, through which people go and the robot does not
        (-20.4, 0.0, 205),  # outside
    ],
)
def test_the_grid_says_where_a_robot_can_go(folder: Path, x: float, y: float, grey: int) -> None:
    cells, origin, side = _cells(folder)
    assert cells[int((y - origin[1]) / side), int((x - origin[0]) / side)] == grey


def test_the_grid_gives_the_same_floor(folder: Path) -> None:
    read = build(FloorPlanSpec.model_validate({"file": str(folder / "map.yaml")}))
    ends = read.walls[read.stops_robot].reshape(-1, 2)
    assert ends.min(axis=0) == pytest.approx([-20.0, -12.0], abs=0.11)
    assert ends.max(axis=0) == pytest.approx([20.0, 12.0], abs=0.11)
    assert sum(_by_height(read).values()) == pytest.approx(
        sum(_by_height(_shed()).values()) + 3 * np.pi * 0.09, rel=0.45
    )  # thin walls are a cell thicker


def test_what_hangs_above_the_robot_is_not_in_the_grid(tmp_path: Path) -> None:
    change = "environment.gates={boom: {start: [0, 4], end: [0, 8], base: 0.5}}"
    assert main(["export-map", SHED, "--out", str(tmp_path), "--set", change]) == 0
    cells, origin, side = _cells(tmp_path)
    assert cells[int((6.0 - origin[1]) / side), int((0.0 - origin[0]) / side)] == 254


def test_outside_a_place_without_robots_and_zones_is_unknown(tmp_path: Path) -> None:
    corners = [[0, 0], [10, 0], [10, 10], [6, 10], [6, 4], [0, 4], [0, 0]]
    (tmp_path / "plan.geojson").write_text(
        json.dumps({"type": "Polygon", "coordinates": [corners]}), encoding="utf-8"
    )
    spec = tmp_path / "spec.yaml"
    spec.write_text(
        "crowdbot: 1\nscenario:\n  id: a\n  environment: {kind: floor_plan, file: plan.geojson}\n",
        encoding="utf-8",
    )
    assert main(["export-map", str(spec), "--out", str(tmp_path)]) == 0
    cells, origin, side = _cells(tmp_path)

    def at(x: float, y: float) -> int:
        return int(cells[int((y - origin[1]) / side), int((x - origin[0]) / side)])

    assert [at(2.0, 2.0), at(8.0, 8.0), at(2.0, 8.0)] == [254, 254, 205]


def test_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["export-map", SHED, "--out", str(tmp_path / "a" / "b"), "--json", "--resolution", "0.2"]
    assert main(argv) == 0
    document = json.loads(capsys.readouterr().out)
    assert [Path(f).name for f in document["files"]] == ["map.pgm", "map.yaml", "map.geojson"]
    assert all(Path(f).is_file() for f in document["files"])
    assert document["resolution"] == 0.2


@pytest.mark.parametrize("resolution", ["0", "-1", "nan", "1e-4"])
def test_impossible_cells(resolution: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export-map", SHED, "--resolution", resolution]) == 2
    assert "a cell is 0.001 m to 10 m wide" in capsys.readouterr().err


def test_too_many_cells(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["export-map", SHED, "--out", str(tmp_path), "--resolution", "0.001"]
    assert main(argv) == 1
    assert "write a larger --resolution" in capsys.readouterr().err


def test_a_corner_is_written_without_rounding_errors() -> None:
    cells = np.zeros((1, 1), np.uint8)
    made = GridMap(cells=cells, origin=(-28 * 0.05, -1.0), resolution=0.05)
    assert "origin: [-1.4, -1.0, 0.0]" in made.to_yaml("map.pgm")
