"""Numbers of plans that cannot be what their unit says."""

from __future__ import annotations

import json
import logging
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.errors import InputError
from crowdbot.plugin import EnvironmentParts
from crowdbot.plugins.environments.floor_plan import FloorPlanSpec
from crowdbot.plugins.environments.place_build import build

CRS84 = "urn:ogc:def:crs:OGC:1.3:CRS84"
ROOM = [[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0], [0.0, 0.0]]
HERE = [[7.60115 + x / 68_000, 51.96304 + y / 111_000] for x, y in ROOM]
GRID = [[405_000.0 + x, 5_757_000.0 + y] for x, y in ROOM]


def _plan(folder: Path, ring: list[list[float]], crs: str = "", **fields: Any) -> EnvironmentParts:
    content: dict[str, Any] = {"type": "Polygon", "coordinates": [ring]}
    if crs:
        content["crs"] = {"type": "name", "properties": {"name": crs}}
    file = folder / "plan.geojson"
    file.write_text(json.dumps(content), "utf-8")
    return build(FloorPlanSpec.model_validate({"file": str(file), **fields}))


def _size(parts: EnvironmentParts) -> list[float]:
    low, high = (f(parts.walls.reshape(-1, 2), axis=0) for f in (np.min, np.max))
    return list((high - low).tolist())


@pytest.mark.parametrize("crs", ["", CRS84, "EPSG:4326", "urn:ogc:def:crs:EPSG::25832"])
def test_degrees_read_as_metres_are_told_what_to_write(tmp_path: Path, crs: str) -> None:
    with pytest.raises(InputError, match=r"40\.3 m × 30\.1 m as longitude and latitude") as caught:
        _plan(tmp_path, HERE, crs)
    assert "(7.60115, 51.96304)" in str(caught.value)
    assert (f"names {crs}" in str(caught.value)) == (crs in (CRS84, "EPSG:4326"))
    lon, lat = map(float, re.findall(r"origin: \[([\d.]+), ([\d.]+)\]", str(caught.value))[0])
    parts = _plan(tmp_path, HERE, crs, unit="deg", origin=[lon, lat])
    assert _size(parts) == pytest.approx([40.3, 30.1], abs=0.2)
    assert np.abs(parts.walls).max() < 21.0


def test_degrees_far_from_the_origin_are_told_theirs(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"origin: \[7\.60144\d, 51\.96317\d\]"):
        _plan(tmp_path, HERE, unit="deg", rotation="30 deg")


def test_metres_are_no_degrees(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"\(405040, 5757030\) is not a longitude and latitude"):
        _plan(tmp_path, GRID, unit="deg")
    with pytest.raises(InputError, match="more than 5000 m; its numbers count as deg"):
        _plan(tmp_path, ROOM, CRS84, unit="deg")


def test_metres_in_a_file_of_degrees_are_warned_of_until_the_unit_is_written(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING, logger="crowdbot"):
        assert _size(_plan(tmp_path, ROOM, CRS84)) == [40.0, 30.0]
    assert "which would be 4448 km: they count as m; write 'unit'" in caplog.text
    caplog.clear()
    with caplog.at_level(logging.WARNING, logger="crowdbot"):
        _plan(tmp_path, ROOM, CRS84, unit="m")
        _plan(tmp_path, ROOM)
    assert not caplog.records


def test_a_national_grid_needs_an_origin(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="5771 km from the world's") as caught:
        _plan(tmp_path, GRID, "EPSG:25832")
    x, y = re.findall(r"origin: \[(\S+ m), (\S+ m)\]", str(caught.value))[0]
    parts = _plan(tmp_path, GRID, "EPSG:25832", origin=[x, y])
    assert np.abs(parts.walls).max() == pytest.approx(20.0, abs=1e-6)


@given(
    unit=st.sampled_from(["m", "cm", "mm", "ft", "in"]),
    origin=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    rotation=st.floats(-3, 3),
    far=st.tuples(st.floats(2e5, 9e6), st.floats(-9e6, 9e6)),
)
def test_the_origin_that_is_told_brings_a_plan_to_the_middle(
    unit: str, origin: tuple[float, float], rotation: float, far: tuple[float, float]
) -> None:
    scale = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}[unit]
    points = [((x + far[0]) / scale, (y + far[1]) / scale) for x, y in ROOM]
    wkt = f"POLYGON (({', '.join(f'{x!r} {y!r}' for x, y in points)}))"
    words = {"wkt": wkt, "unit": unit, "rotation": rotation}
    with pytest.raises(InputError, match="km from the world's") as caught:
        build(FloorPlanSpec.model_validate({**words, "origin": origin}))
    values = re.findall(r"origin: \[(\S+ m), (\S+ m)\]", str(caught.value))[0]
    parts = build(FloorPlanSpec.model_validate({**words, "origin": values}))
    low, high = (f(parts.walls.reshape(-1, 2), axis=0) for f in (np.min, np.max))
    assert np.abs(low + high).max() < 0.1
