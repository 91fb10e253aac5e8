"""Floor plans: what files say becomes walls, and what is wrong with them is said."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from pydantic import ValidationError

from crowdbot.errors import InputError
from crowdbot.plugin import EnvironmentParts
from crowdbot.plugins.environments import floor_plan_build as build_module
from crowdbot.plugins.environments.floor_plan import FloorPlanSpec
from crowdbot.plugins.environments.place_build import build

_FEATURE = '{"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2]}}'
L_SHAPE = "POLYGON ((0 0, 12 0, 12 4, 8 4, 8 9, 0 9, 0 0), (3 2, 4 2, 4 3, 5 3, 5 4, 3 4, 3 2))"


def _plan(**fields: Any) -> EnvironmentParts:
    return build(FloorPlanSpec.model_validate(fields))


def _file(tmp_path: Path, name: str, content: str | bytes) -> str:
    path = tmp_path / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return str(path)


def _solid_area(parts: EnvironmentParts) -> float:
    return float(sum(shapely.Polygon(s).area for s in parts.solids))


def _floor(parts: EnvironmentParts) -> Any:
    lines = shapely.linestrings(parts.walls[parts.stops_robot].reshape(-1, 2, 2))
    return shapely.union_all(shapely.get_parts(shapely.polygonize(lines)))


def test_a_concave_room_with_a_concave_hole() -> None:
    parts = _plan(wkt=L_SHAPE)
    assert _floor(parts).area == pytest.approx(12 * 4 + 8 * 5)
    assert _solid_area(parts) == pytest.approx(3.0)
    assert len(parts.walls) == 6 + 6
    inside, solid = shapely.Point(6.0, 3.0), shapely.Point(3.5, 2.5)
    assert not any(shapely.Polygon(s).contains(inside) for s in parts.solids)
    assert any(shapely.Polygon(s).contains(solid) for s in parts.solids)


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("wkt", "POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0))"),
        (
            "geojson",
            '{"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]]}',
        ),
    ],
)
def test_a_byte_order_mark_changes_nothing(tmp_path: Path, kind: str, text: str) -> None:
    plain, marked = (
        _plan(file=_file(tmp_path, f"{name}.{kind}", content))
        for name, content in (("plain", text), ("marked", "\ufeff" + text))
    )
    assert _floor(marked).equals(_floor(plain))


@pytest.mark.parametrize(
    "text",
    [
        "POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0));",
        '"POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0))"',
        "# a room\nPOLYGON ((0 0, 2 0, 2 3, 0 3, 0 0))\n\nPOLYGON ((2 0, 4 0,\n 4 3, 2 3, 2 0))\n",
        "POLYGON M ((0 0 9, 4 0 9, 4 3 9, 0 3 9, 0 0 9))",
        "POLYGON ZM ((0 0 1 9, 4 0 1 9, 4 3 1 9, 0 3 1 9, 0 0 1 9))",
    ],
)
def test_wkt_as_databases_write_it(tmp_path: Path, text: str) -> None:
    parts = _plan(file=_file(tmp_path, "rooms.wkt", text), least_area=0.0)
    assert _floor(parts).area == pytest.approx(12.0)


@pytest.mark.parametrize(("unit", "scale"), [("cm", 0.01), ("mm", 0.001), ("ft", 0.3048)])
def test_units_origin_and_rotation(unit: str, scale: float) -> None:
    parts = _plan(wkt=L_SHAPE, unit=unit, least_area=0.0, origin=[3.0, -2.0], rotation="90 deg")
    x, y = parts.walls.reshape(-1, 2).T
    assert [x.min(), x.max()] == pytest.approx([3.0 - 9 * scale, 3.0], abs=2e-6)
    assert [y.min(), y.max()] == pytest.approx([-2.0, -2.0 + 12 * scale], abs=2e-6)


def test_degrees_become_metres() -> None:
    lon, lat = 8.5, 47.0
    text = f"POLYGON (({lon} {lat}, {lon + 1e-3} {lat}, {lon + 1e-3} {lat + 1e-3}, {lon} {lat}))"
    parts = _plan(wkt=text, unit="deg", origin=[lon, lat])
    x, y = parts.walls.reshape(-1, 2).T
    assert x.max() == pytest.approx(111.195 * np.cos(np.radians(47.0)), rel=1e-3)
    assert y.max() == pytest.approx(111.195, rel=1e-3)


def test_geometry_of_jupedsim_is_put_together() -> None:
    rooms = "POLYGON ((0 0, 5 0, 5 5, 0 5, 0 0))", "POLYGON ((5 2, 9 2, 9 3, 5 3, 5 2))"
    parts = _plan(wkt=f"GEOMETRYCOLLECTION ({', '.join(rooms)})")
    assert _floor(parts).area == pytest.approx(29.0)
    middle = shapely.LineString([(4.0, 2.5), (6.0, 2.5)])  # no wall across the opening
    lines = shapely.linestrings(parts.walls.reshape(-1, 2, 2))
    assert not np.any(shapely.intersects(lines, middle))


def test_features_say_what_they_are(tmp_path: Path) -> None:
    def feature(kind: str, wkt: str, **more: float) -> dict[str, Any]:
        shape = json.loads(shapely.to_geojson(shapely.from_wkt(wkt)))
        return {"type": "Feature", "properties": {"kind": kind, **more}, "geometry": shape}

    content = {
        "type": "FeatureCollection",
        "features": [
            feature("walkable", "POLYGON ((0 0, 9 0, 9 5, 0 5, 0 0))"),
            feature("obstacle", "POLYGON ((2 2, 3 2, 3 3, 2 3, 2 2))", height=0.3),
            feature("obstacle", "LINESTRING (5 1, 5 4)", base=0.3, height=1.1),
            feature("zone", "POLYGON ((1 1, 2 1, 2 2, 1 1))"),
        ],
    }
    parts = _plan(file=_file(tmp_path, "plan.geojson", json.dumps(content)))
    assert sorted(map(tuple, parts.solid_heights.tolist())) == [(0.0, 0.3), (0.3, 1.1)]
    assert _solid_area(parts) == pytest.approx(1.0 + 0.3)
    assert _floor(parts).area == pytest.approx(45.0)


def test_a_bow_tie_is_repaired_with_a_warning(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        parts = _plan(wkt="POLYGON ((0 0, 4 4, 4 0, 0 4, 0 0))")
    assert "wkt: an outline was repaired: Self-intersection[2 2]" in caplog.text
    assert _floor(parts).area == pytest.approx(8.0)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.wkt", "POLYGON ((0 0, 1", "is not well-known text"),
        ("a.geojson", '{"type": "FeatureCollection", "features": []}', "it has no features"),
        (
            "a.wkt",
            "\n" + "GEOMETRYCOLLECTION (" * 100 + ")" * 100,
            "line 2, column 1300: nested deeper than 64 brackets",
        ),
        ("a.wkt", " " * 8_000_001, "is larger than 8 MB"),
        ("a.geojson", '{"type": "Polygon", "coordinates": [[[' + "9" * 6000, "digits"),
        ("a.geojson", '{"a": ' * 100 + "1" + "}" * 100, "deeper than 64 brackets"),
        ("a.geojson", " " * 8_000_001, "is larger than 8 MB"),
        ("map.yaml", "image: &a m.pgm\n", r"map.yaml:1:8: error\[E004\]"),
        ("a.wkt", "POINT (1 1)", "neither a floor nor a wall"),
        (
            "a.geojson",
            '{"type": "FeatureCollection",\n "features": [',
            "is not JSON: line 2, column 15",
        ),
        ("a.geojson", '{"type": "Topology"}', "type 'Topology'"),
        ("a.geojson", f"\n{_FEATURE}\n{_FEATURE}\n", "one feature in each line"),
        ("a.geojson", f"\x1e{_FEATURE}\n\x1e{_FEATURE}\n", "one feature in each line"),
        ("a.geojson", '{"type": "Polygon", "coordinates": [[1]]}', "a Polygon is damaged"),
        (
            "a.geojson",
            '{"type": "Polygon", "coordinates": [[[0, 0], [true, 0], [9, 8], [0, 0]]]}',
            "a Polygon is damaged: true is not a number",
        ),
        ("a.geojson", "[" * 100_000, "is not JSON"),
        (
            "a.geojson",
            '{"type": "Polygon", "coordinates": [[[0, 0], [NaN, 0], [9, 8], [0, 0]]]}',
            "a coordinate is not finite",
        ),
        ("a.geojson", b"\xff\xfe", "cannot be read: is not UTF-8"),
        ("map.yaml", "resolution: 0.1\n", "names no image"),
        ("map.yaml", "image: m.pgm\nresolution: 0\norigin: [0, 0, 0]\n", "above 0"),
        ("map.yaml", "image: m.pgm\nresolution: 0.1\n", "origin is missing"),
        (
            "map.yaml",
            "image: m.pgm\nresolution: five\norigin: [0, 0, 0]\n",
            "resolution: 'five' is not a number",
        ),
        ("map.yaml", "image: m.pgm\nresolution: -1\norigin: [0, 0, 0]\n", "above 0"),
        ("map.yaml", "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n", "m.pgm: cannot be"),
        (
            "map.yaml",
            "image: x\nresolution: 1\norigin: [0, 0, 0]\nfree_thresh: 0.9\n",
            "0 <= free <= occupied",
        ),
    ],
)
def test_what_is_wrong_is_said(
    name: str, content: str | bytes, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=message):
        _plan(file=_file(tmp_path, name, content))


def test_too_many_corners(tmp_path: Path) -> None:
    angles = np.linspace(0.0, 2 * np.pi, 21_000, endpoint=False)
    corners = 50.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    path = _file(tmp_path, "round.wkt", shapely.Polygon(corners).wkt)
    with pytest.raises(InputError, match="21001 corners, more than 20000; raise 'tolerance'"):
        _plan(file=path)
    assert len(_plan(file=path, tolerance="1 cm").walls) < 500


def test_a_refused_plan_is_read_once_and_one_that_could_not_be_opened_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, calls = _file(tmp_path, "none.wkt", "POLYGON EMPTY"), list[str]()
    text = vars(build_module)["input_text"]

    def slow(file: Path, largest: int, name: str) -> str:
        calls.append(name)
        if len(calls) == 1:
            try:
                raise OSError("too many open files")
            except OSError as error:
                raise InputError(f"{name}: {error}") from None
        return str(text(file, largest, name))

    monkeypatch.setattr(build_module, "input_text", slow)
    for message in ("too many open files", "the plan is empty", "the plan is empty"):
        with pytest.raises(InputError, match=message):
            _plan(file=path)
    assert calls == ["none.wkt", "none.wkt"]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, "write one of 'file' and 'wkt'"),
        ({"file": "x.geojson", "wkt": L_SHAPE}, "write one of"),
        ({"wkt": L_SHAPE, "format": "ros_map"}, "needs a .file."),
        ({"file": "x.dwg"}, "write its 'format'"),
        ({"file": "x.PGM"}, "name the map.yaml beside it"),
    ],
)
def test_words_that_make_no_sense(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        FloorPlanSpec.model_validate(fields)


# ------------------------------------------------------------------------ occupancy grids
GREY = {".": 254, "#": 0, "?": 205}
ROOM = ["########", "#......#", "#..##..#", "#..##..#", "#......#", "########", "????????"]


def _map(tmp_path: Path, picture: list[str] = ROOM, binary: bool = True, **more: Any) -> str:
    rows = np.array([[GREY[c] for c in row] for row in picture], np.uint8)
    rows = 255 - rows if more.get("negate") else rows
    size = f"{rows.shape[1]} {rows.shape[0]}\n255\n"
    if binary:
        _file(tmp_path, "m.pgm", b"P5\n# made here\n" + size.encode() + rows.tobytes())
    else:
        text = "\n".join(" ".join(map(str, row)) for row in rows.tolist())
        _file(tmp_path, "m.pgm", f"P2\n{size}{text}\n")
    words = {"image": "m.pgm", "resolution": 0.5, "origin": [1.0, 2.0, 0.0], "negate": 0} | more
    return _file(tmp_path, "map.yaml", "".join(f"{k}: {v}\n" for k, v in words.items()))


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("negate", [0, 1])
def test_an_occupancy_grid(tmp_path: Path, binary: bool, negate: int) -> None:
    parts = _plan(file=_map(tmp_path, binary=binary, negate=negate), tolerance=0.0)
    assert _floor(parts).bounds == pytest.approx((1.5, 3.0, 4.5, 5.0))
    assert _solid_area(parts) == pytest.approx(1.0)  # 2 x 2 cells
    assert shapely.union_all([shapely.Polygon(s) for s in parts.solids]).bounds == pytest.approx(
        (2.5, 3.5, 3.5, 4.5)
    )


def test_origin_may_be_turned(tmp_path: Path) -> None:
    parts = _plan(file=_map(tmp_path, origin=[1.0, 2.0, np.pi / 2]), tolerance=0.0)
    # x' = 1 - y, y' = 2 + x with y from 1 to 3 and x from 0.5 to 3.5 above the corner
    assert _floor(parts).bounds == pytest.approx((-2.0, 2.5, 0.0, 5.5))


def test_thresholds_decide_what_is_unknown(tmp_path: Path) -> None:
    picture = ["........", "..????..", "..????..", "........"]
    solid = _plan(file=_map(tmp_path, picture), tolerance=0.0)
    assert _solid_area(solid) == pytest.approx(2.0)
    free = _plan(file=_map(tmp_path, picture), tolerance=0.0, unknown="free")
    assert _solid_area(free) == 0.0
    strict = _map(tmp_path, picture, occupied_thresh=0.1, free_thresh=0.1)
    taken = _plan(file=strict, tolerance=0.0, unknown="free")
    assert _solid_area(taken) == pytest.approx(2.0)


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b" # brightest\n"])
def test_pixels_begin_after_the_header_of_any_program(tmp_path: Path, end: bytes) -> None:
    cells = np.full((6, 8), 254, np.uint8)
    cells[[0, -1]], cells[:, [0, -1]] = 0, 0
    _file(tmp_path, "m.pgm", b"P5\n8 6\n255" + end + cells.tobytes())
    text = "image: m.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\n"
    parts = _plan(file=_file(tmp_path, "map.yaml", text), tolerance=0.0)
    assert _floor(parts).bounds == pytest.approx((0.5, 0.5, 3.5, 2.5))


def test_unknown_cells_that_count_as_free_are_told(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    cells = np.full((6, 8), 205, np.uint8)
    cells[1:-1, 1:-1] = 254
    _file(tmp_path, "m.pgm", b"P5\n8 6\n255\n" + cells.tobytes())
    text = "image: m.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\nfree_thresh: "
    with caplog.at_level(logging.WARNING):
        strict = _plan(file=_file(tmp_path, "a.yaml", text + "0.196\n"), tolerance=0.0)
        assert caplog.text == ""
        loose = _plan(file=_file(tmp_path, "b.yaml", text + "0.25\n"), tolerance=0.0)
    assert _floor(strict).area < _floor(loose).area == pytest.approx(12.0)
    assert "m.pgm: 24 cells are grey 205" in caplog.text


@pytest.mark.parametrize("negate", [0, 1])
def test_raw_pixels_are_per_cent(tmp_path: Path, negate: int) -> None:
    """As nav2 reads them: ``negate`` means nothing there, and above 100 nothing is known."""
    cells = np.zeros((6, 8), np.uint8)
    cells[[0, -1]], cells[:, [0, -1]], cells[2:4, 3:5], cells[1, 1] = 100, 100, 255, 10
    _file(tmp_path, "m.pgm", b"P5\n8 6\n255\n" + cells.tobytes())
    text = f"image: m.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: {negate}\nmode: raw\n"
    parts = _plan(file=_file(tmp_path, "map.yaml", text), tolerance=0.0)
    assert _floor(parts).bounds == pytest.approx((0.5, 0.5, 3.5, 2.5))
    assert _solid_area(parts) == pytest.approx(1.0)
    unknown = _plan(file=str(tmp_path / "map.yaml"), tolerance=0.0, unknown="free")
    assert _solid_area(unknown) == 0.0
    none = _plan(file=_file(tmp_path, "none.yaml", f"{text}free_thresh: 0\n"), tolerance=0.0)
    assert _floor(none).area == pytest.approx(_floor(parts).area - 0.25)  # 10 % is not free


@pytest.mark.parametrize(
    ("mode", "colour", "alpha", "solid"),
    [
        ("scale", 1.0, 0.0, 1.0),  # unknown
        ("trinary", 1.0, 0.0, 1.0),  # shade (3 + 0) / 4: unknown
        ("trinary", 1.0, 0.5, 0.0),  # shade (3 + 0.5) / 4: free
        ("trinary", 0.8, 1.0, 0.0),  # shade (2.4 + 1) / 4: free, unknown without opacity
        ("raw", 0.0, 0.0, 0.0),  # per cent, whatever the opacity
    ],
)
def test_transparent_pixels_mean_what_they_mean_to_nav2(
    tmp_path: Path, mode: str, colour: float, alpha: float, solid: float
) -> None:
    from matplotlib.image import imsave

    cells = np.ones((6, 8, 4))
    cells[..., :3] = 0.0 if mode == "raw" else 1.0
    border = 100 / 255 if mode == "raw" else 0.0
    cells[[0, -1], :, :3], cells[:, [0, -1], :3] = border, border
    cells[2:4, 3:5] = colour, colour, colour, alpha
    imsave(tmp_path / "m.png", cells)
    text = f"image: m.png\nresolution: 0.5\norigin: [0, 0, 0]\nmode: {mode}\n"
    parts = _plan(file=_file(tmp_path, "map.yaml", text), tolerance=0.0)
    assert _solid_area(parts) == pytest.approx(solid)


def test_an_unknown_mode_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"mode 'trinry' is not one of .*did you mean 'trinary'"):
        _plan(file=_map(tmp_path, mode="trinry"))


def test_png_too_and_slanted_walls_become_straight(tmp_path: Path) -> None:
    from matplotlib.image import imsave

    size = 200
    x, y = np.meshgrid(np.arange(size), np.arange(size))
    wall = np.abs(y - 0.5 * x - 40) < 4
    imsave(tmp_path / "m.png", np.where(wall, 0.0, 1.0), cmap="gray", vmin=0.0, vmax=1.0)
    text = "image: m.png\nresolution: 0.05\norigin: [0, 0, 0]\n"
    parts = _plan(file=_file(tmp_path, "map.yaml", text))
    assert len(parts.walls) < 40  # staircases of 200 steps are simplified
    assert _floor(parts).area == pytest.approx((~wall).sum() * 0.0025, rel=0.01)


def test_damaged_images(tmp_path: Path) -> None:
    path = _map(tmp_path)
    for content, message in (
        (b"P5\n8 8\n255\n123", "3 pixels, fewer than"),
        (b"P5\nx", "header is damaged"),
        (b"GIF89a", "damaged GIF"),
        (b"\x89PNG\r\n\x1a\nxx", "damaged PNG"),
        (b"P5\n9999999 99999\n255\n", "are not an image of a map"),
    ):
        (tmp_path / "m.pgm").write_bytes(content)
        with pytest.raises(InputError, match=message):
            _plan(file=path, wall_height=1.0 + len(content))  # another one, so that it is read
