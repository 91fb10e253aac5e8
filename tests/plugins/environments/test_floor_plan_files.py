"""Plans as others write them: nothing vanishes, nothing is joined or dropped without a word."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from PIL import Image, ImageDraw

from crowdbot.cli import main
from crowdbot.errors import InputError
from crowdbot.plugin import EnvironmentParts
from crowdbot.plugins.environments.floor_plan import FloorPlanSpec
from crowdbot.plugins.environments.place_build import build

HALL = "POLYGON ((0 0, 9 0, 9 5, 0 5, 0 0))"
Log = pytest.LogCaptureFixture


def _plan(**fields: Any) -> EnvironmentParts:
    return build(FloorPlanSpec.model_validate(fields))


def _geojson(tmp_path: Path, *features: tuple[str | None, dict[str, Any]], bom: str = "") -> str:
    listed = [
        {
            "type": "Feature",
            "properties": properties,
            "geometry": None if wkt is None else shapely.geometry.mapping(shapely.from_wkt(wkt)),
        }
        for wkt, properties in features
    ]
    file = tmp_path / "plan.geojson"
    file.write_text(bom + json.dumps({"type": "FeatureCollection", "features": listed}), "utf-8")
    return str(file)


def _solid(parts: EnvironmentParts) -> Any:
    return shapely.union_all([shapely.Polygon(s) for s in parts.solids])


# ------------------------------------------------------------------------------- GeoJSON
def test_null_geometry_and_null_heights(tmp_path: Path, caplog: Log) -> None:
    block = "POLYGON ((2 2, 3 2, 3 3, 2 3, 2 2))"
    words = {"kind": "obstacle", "base": None, "height": None}
    parts = _plan(file=_geojson(tmp_path, (HALL, {}), (None, {"name": "x"}), (block, words)))
    assert parts.solid_heights.tolist() == [[0.0, 2.5]]
    assert "plan.geojson: left out: 1 feature(s) without geometry" in caplog.text


def test_shapes_without_size_are_told(tmp_path: Path, caplog: Log) -> None:
    empty, dot = "POLYGON EMPTY", "LINESTRING (3 1, 3 1)"
    parts = _plan(file=_geojson(tmp_path, (HALL, {}), (empty, {}), (dot, {"kind": "wall"})))
    assert not parts.solids
    assert "1 feature(s) with an empty geometry, 1 feature(s) without length" in caplog.text


def test_null_in_a_collection(tmp_path: Path) -> None:
    box = shapely.geometry.mapping(shapely.from_wkt(HALL))
    content = {"type": "GeometryCollection", "geometries": [None, box]}
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(content))
    assert len(_plan(file=str(file)).walls) == 4


@pytest.mark.parametrize("kind", ["wall", "Obstacle", " OBSTACLE "])
def test_known_kinds_in_any_case(kind: str, tmp_path: Path) -> None:
    parts = _plan(file=_geojson(tmp_path, (HALL, {}), ("LINESTRING (4 1, 4 4)", {"kind": kind})))
    assert _solid(parts).area == pytest.approx(0.3)


def test_a_misspelled_kind_is_an_error(tmp_path: Path) -> None:
    path = _geojson(tmp_path, (HALL, {}), ("LINESTRING (4 1, 4 4)", {"kind": "obstacel"}))
    with pytest.raises(InputError, match=r"kind 'obstacel' is not one of .*mean 'obstacle'"):
        _plan(file=path)


def test_another_kind_is_not_taken_for_a_wall(tmp_path: Path, caplog: Log) -> None:
    path = _geojson(tmp_path, (HALL, {}), ("LINESTRING (4 1, 4 4)", {"kind": "centre line"}))
    assert not _plan(file=path).solids
    assert "left out: 1 feature(s) of kind 'centre line' (known: walkable" in caplog.text


@pytest.mark.parametrize("levels", [("0", "1"), (0, 1), (0.0, "1;2")])
def test_storeys_are_not_joined(levels: tuple[Any, Any], tmp_path: Path) -> None:
    upper = "POLYGON ((0 0, 20 0, 20 5, 0 5, 0 0))"
    path = _geojson(tmp_path, (HALL, {"level": levels[0]}), (upper, {"level": levels[1]}))
    with pytest.raises(InputError, match=r"storeys in it: '0' \(1\), '1' \(1\).*which 'level'"):
        _plan(file=path)
    assert _plan(file=path, level=0).walls[:, 0].max() == 9.0
    assert _plan(file=path, level="1").walls[:, 0].max() == 20.0
    with pytest.raises(InputError, match=r"level '7' is not one of '0'"):
        _plan(file=path, level=7)


def test_storeys_by_height(tmp_path: Path) -> None:
    flat, high = (
        "POLYGON Z ((0 0 0, 9 0 0, 9 5 0, 0 0 0))",
        "POLYGON Z ((0 0 3, 8 0 3, 8 5 3, 0 0 3))",
    )
    path = _geojson(tmp_path, (flat, {}), (high, {}))
    with pytest.raises(InputError, match=r"2 storeys in it: '0' \(1\), '3' \(1\)"):
        _plan(file=path)
    assert _plan(file=path, level=3).walls[:, 0].max() == 8.0


def test_floor_that_lies_on_floor_is_told(caplog: Log) -> None:
    _plan(wkt=f"GEOMETRYCOLLECTION ({HALL}, {HALL})")
    assert "polygons of the floor lie upon each other, 45 m²" in caplog.text


@pytest.mark.parametrize("kind", ["Polygn", "Curve"])
def test_an_unknown_geometry(kind: str, tmp_path: Path) -> None:
    file = tmp_path / "a.geojson"
    file.write_text(json.dumps({"type": kind}))
    hint = "did you mean 'Polygon'" if kind == "Polygn" else "type 'Curve'"
    with pytest.raises(InputError, match=hint):
        _plan(file=str(file))


# ----------------------------------------------------------------------------------- WKT
@pytest.mark.parametrize(
    ("wkt", "message"),
    [
        ("CURVEPOLYGON ((0 0, 10 0, 10 6, 0 6, 0 0))", "curves are not read"),
        ("CIRCULARSTRING (0 0, 1 1, 2 0)", "curves are not read"),
        ("GEOMETRYCOLLECTION (COMPOUNDCURVE ((0 0, 1 1)))", "curves are not read"),
        ("MULTISURFACE (((0 0, 10 0, 10 6, 0 6, 0 0)))", "curves are not read"),
        ("POLYGON EMPTY", "the plan is empty"),
        ("GEOMETRYCOLLECTION EMPTY", "the plan is empty"),
        ("MULTIPOLYGON EMPTY", "the plan is empty"),
        ("", "is not well-known text"),
    ],
)
def test_geometry_that_is_no_plan(wkt: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        _plan(wkt=wkt)


def test_wkt_of_postgis() -> None:
    assert len(_plan(wkt=f"SRID=25832;{HALL}").walls) == 4


@pytest.mark.parametrize("name", ["plan.geojson", "plan.wkt", "map.yaml"])
def test_byte_order_marks(name: str, tmp_path: Path) -> None:
    _image(tmp_path / "map.png")
    content = {
        "plan.wkt": HALL,
        "plan.geojson": json.dumps(shapely.geometry.mapping(shapely.from_wkt(HALL))),
        "map.yaml": "image: map.png\nresolution: 0.1\norigin: [0, 0, 0]\n",
    }[name]
    (tmp_path / name).write_text("\ufeff" + content, "utf-8")
    assert len(_plan(file=str(tmp_path / name)).walls) == 4
    assert len(_plan(wkt="\ufeff" + HALL).walls) == 4


# --------------------------------------------------------------------- floor in a hole
def test_floor_within_a_hole() -> None:
    ring = "((0 0, 20 0, 20 20, 0 20, 0 0), (5 5, 15 5, 15 15, 5 15, 5 5))"
    inner = "((6 6, 14 6, 14 14, 6 14, 6 6), (9 9, 11 9, 11 11, 9 11, 9 9))"
    spec = FloorPlanSpec.model_validate({"wkt": f"MULTIPOLYGON ({ring}, {inner})"})
    place, parts = spec.place(), build(spec)
    assert _solid(parts).area == pytest.approx(100 - 64 + 4)
    for x, y, gap in ((7.0, 7.0, 1.0), (10.0, 10.0, -1.0), (5.5, 10.0, -0.5), (2.5, 2.5, 2.5)):
        assert place.clearance(x, y) == pytest.approx(gap)


def test_thin_walls_between_rooms_do_not_reach_into_them() -> None:
    """What stops a robot is 0.2 m thick behind an outer wall; this wall is 0.1 m thick."""
    rooms = "((0 0, 5 0, 5 5, 0 5, 0 0)), ((5.1 0, 9 0, 9 5, 5.1 5, 5.1 0))"
    parts = _plan(wkt=f"MULTIPOLYGON ({rooms})")
    assert not parts.stops_robot.any()
    solid = _solid(parts)
    assert solid.contains(shapely.Point(5.05, 2.5))
    assert solid.intersection(shapely.from_wkt(f"MULTIPOLYGON ({rooms})")).area < 1e-6


# ------------------------------------------------------------------------- what is small
def test_what_is_too_small_is_told_and_drawn(caplog: Log, tmp_path: Path) -> None:
    holes = "(2 2, 2.1 2, 2.1 2.1, 2 2.1, 2 2), (3 2, 4 2, 4 3, 3 3, 3 2)"
    wkt = f"POLYGON ((0 0, 9 0, 9 5, 0 5, 0 0), {holes})"
    parts = _plan(wkt=wkt)
    assert _solid(parts).area == pytest.approx(1.0)
    assert [shapely.Polygon(p).area for p in parts.left_out] == [pytest.approx(0.01)]
    assert "1 piece smaller than least_area, 0.02 m²; the largest has 0.01 m²" in caplog.text
    assert _solid(_plan(wkt=wkt, least_area=0.0)).area == pytest.approx(1.01)
    spec = tmp_path / "x.yaml"
    spec.write_text(
        "crowdbot: 1\nscenario: {id: x, environment: {kind: floor_plan, zones: {}, "
        f'wkt: "{wkt}"}}}}\n'
    )
    assert main(["view", str(spec), "--out", str(tmp_path / "x.svg")]) == 0
    assert "too small: left out" in (tmp_path / "x.svg").read_text()


def test_a_thin_wall_survives_a_coarse_tolerance() -> None:
    wall = "(2 2, 2 2.1, 5 2.5, 8 2.1, 8 2, 5 2.4, 2 2)"
    parts = _plan(wkt=f"POLYGON ((0 0, 9 0, 9 5, 0 5, 0 0), {wall})", tolerance="0.5 m")
    assert _solid(parts).area == pytest.approx(1.2, rel=0.1)


# --------------------------------------------------------------------------------- images
def _image(file: Path, line: tuple[int, int, int, int] | None = None) -> None:
    image = Image.new("L", (80, 60), 254)
    draw = ImageDraw.Draw(image)
    draw.rectangle((0, 0, 79, 59), outline=0, width=3)
    if line:
        draw.line(line, fill=0)
    image.save(file)


def _scenario(tmp_path: Path, image: str, more: str = "") -> str:
    (tmp_path / "map.yaml").write_text(f"image: {image}\nresolution: 0.1\norigin: [0, 0, 0]\n")
    spec = tmp_path / "x.yaml"
    spec.write_text(
        "crowdbot: 1\nscenario: {id: x, environment: {kind: floor_plan, zones: {}, "
        f"file: map.yaml{more}}}}}\n"
    )
    return str(spec)


@pytest.mark.parametrize("path", ["/home/lab/maps/map.png", "'C:\\maps\\map.png'"])
def test_an_absolute_path_means_the_image_beside_the_map(path: str, tmp_path: Path) -> None:
    spec = _scenario(tmp_path, path)
    assert main(["validate", spec]) == 1
    _image(tmp_path / "map.png")
    assert main(["validate", spec]) == 0


def test_a_missing_image_is_explained(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec = _scenario(tmp_path, "images/map.png")
    assert main(["validate", spec]) == 1
    shown = capsys.readouterr().err
    assert "no file 'images/map.png'" in shown
    assert "'map.yaml' names it; put it there, or write 'image' beside 'file'" in shown
    _image(tmp_path / "other.png")
    assert main(["validate", _scenario(tmp_path, "images/map.png", ", image: other.png")]) == 0


def test_grids_keep_what_is_small(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _image(tmp_path / "map.png", (20, 20, 21, 20))
    spec = _scenario(tmp_path, "map.png")
    assert main(["validate", spec, "--against-image"]) == 0
    assert "map.png: 4800 cells, 0 differ" in capsys.readouterr().out
    small = _scenario(tmp_path, "map.png", ", least_area: 0.1")
    assert main(["validate", small, "--against-image"]) == 0
    assert "0 differ; 2 left out" in capsys.readouterr().out
    coarse = _scenario(tmp_path, "map.png", ", tolerance: 1, unknown: free")
    _image(tmp_path / "map.png", (3, 3, 60, 40))
    main(["validate", coarse, "--against-image", "--json"])
    (one,) = json.loads(capsys.readouterr().out)
    assert (one["cells"], one["scenario"]) == (4800, "x")


def test_one_damaged_map_among_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _image(tmp_path / "map.png")
    good = _scenario(tmp_path, "map.png")
    bad = tmp_path / "bad.yaml"
    bad.write_text(Path(good).read_text().replace("map.yaml", "lost.yaml"))
    (tmp_path / "lost.yaml").write_text("image: lost.bmp\nresolution: 0.1\norigin: [0, 0, 0]\n")
    (tmp_path / "lost.bmp").write_bytes(b"BM")
    assert main(["validate", str(bad), good, "--against-image"]) == 1
    shown = capsys.readouterr()
    assert "0 differ" in shown.out
    assert "lost.bmp: is a damaged BMP image" in shown.err
    (tmp_path / "lost.yaml").write_text(
        "image: C:/maps/lost.yaml\nresolution: 0.1\norigin: [0, 0, 0]\n"
    )
    assert main(["validate", str(bad)]) == 1
    assert "not its picture; a map names its picture with image" in capsys.readouterr().err


def test_a_document_without_a_grid(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "challenge-2020", "--against-image"]) == 0
    assert capsys.readouterr().out == "no occupancy grid in it\n"


def test_a_coloured_and_a_deep_image(tmp_path: Path) -> None:
    for image in (
        Image.new("RGB", (80, 60), (254, 254, 254)),
        Image.new("L", (80, 60), 254).convert("P"),
        Image.fromarray(np.full((60, 80), 65000, np.uint16)),
        Image.new("1", (80, 60), 1),
        Image.new("LA", (80, 60), (254, 255)),
    ):
        image.save(tmp_path / "map.png")
        text = f"image: map.png\nresolution: 0.1\norigin: [0, 0, 0]\n# {image.mode}\n"
        (tmp_path / "map.yaml").write_text(text)
        assert len(_plan(file=str(tmp_path / "map.yaml")).walls) == 4, image.mode


def test_corners_whose_heights_are_null(tmp_path: Path) -> None:
    ring: list[list[float | None]] = [
        [0, 0, None],
        [10, 0, None],
        [10, 6, 1],
        [0, 6, None],
        [0, 0, None],
    ]
    file = tmp_path / "plan.json"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    assert len(_plan(file=str(file)).walls) == 4
    ring[1][0] = None
    file.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    with pytest.raises(InputError, match="a Polygon is damaged"):
        _plan(file=str(file))


@pytest.mark.parametrize("resolution", [0.1, 0.5, 2.0])
def test_cells_beyond_what_is_solid_around_thin_walls_are_no_floor(
    tmp_path: Path, resolution: float
) -> None:
    """The outer border is thicker than the block that encloses the floor."""
    cells = np.full((20, 30), 254, np.uint8)
    cells[:3] = cells[-3:] = 0
    cells[:, :3] = cells[:, -3:] = 0
    cells[3:14, 12] = 0  # too thin for walls with a thickness behind their face
    Image.fromarray(cells).save(tmp_path / "map.png")
    text = f"image: map.png\nresolution: {resolution}\norigin: [1.0, 2.0, 0.3]\n"
    (tmp_path / "map.yaml").write_text(text, "utf-8")
    found = FloorPlanSpec.model_validate({"file": str(tmp_path / "map.yaml")}).against_image()
    assert found is not None
    assert (found.cells, found.wrong) == (600, 0)


RING = [(0, 0), (9, 0), (9, 5), (0, 5)]


@pytest.mark.parametrize(
    ("hole", "floor"),
    [
        ([(0, 1), (1, 1), (1, 2), (0, 2)], 44.0),  # touches the outline
        ([(-1, 1), (1, 1), (1, 2), (-1, 2)], 44.0),  # leaves it
        ([(20, 20), (21, 20), (21, 21), (20, 21)], 45.0),  # lies outside
        ([(2, 1), (4, 3), (4, 1), (2, 3)], 43.0),  # crosses itself
    ],
)
def test_no_hole_becomes_floor(hole: list[tuple[float, float]], floor: float, caplog: Log) -> None:
    found = FloorPlanSpec.model_validate({"wkt": shapely.Polygon(RING, [hole]).wkt}).place()
    outer = sum(shapely.Polygon(face.points).area for face in found.faces)
    inner = sum(shapely.Polygon(solid.outline).area for solid in found.solids)
    assert outer - inner == pytest.approx(floor)
    assert "repaired" in caplog.text


def test_rooms_that_overlap_are_joined_not_cut_out() -> None:
    wkt = "MULTIPOLYGON (((0 0, 9 0, 9 5, 0 5, 0 0)), ((8 1, 14 1, 14 4, 8 4, 8 1)))"
    found = FloorPlanSpec.model_validate({"wkt": wkt}).place()
    assert [shapely.Polygon(face.points).area for face in found.faces] == [pytest.approx(60.0)]
    assert not found.solids


@pytest.mark.parametrize(
    "image",
    ["~/map.png", "$(find room)/maps/map.png", "package://room/map.png", "file:///home/a/map.png"],
)
def test_images_whose_place_only_the_other_machine_knows_lie_beside_their_map(
    tmp_path: Path, image: str
) -> None:
    Image.fromarray(np.full((20, 30), 254, np.uint8)).save(tmp_path / "map.png")
    text = f"image: {image}\nresolution: 0.1\norigin: [0, 0, 0]\n"
    (tmp_path / "map.yaml").write_text(text, "utf-8")
    found = FloorPlanSpec.model_validate({"file": str(tmp_path / "map.yaml")}).place()
    assert [shapely.Polygon(face.points).area for face in found.faces] == [pytest.approx(6.0)]


def test_a_pixel_above_what_the_header_says_is_refused(tmp_path: Path) -> None:
    (tmp_path / "map.pgm").write_text("P2\n2 2\n100\n100 0 254 100\n", "utf-8")
    text = "image: map.pgm\nresolution: 1.0\norigin: [0, 0, 0]\n"
    (tmp_path / "map.yaml").write_text(text, "utf-8")
    with pytest.raises(InputError, match="a pixel is 254, but its header says at most 100"):
        build(FloorPlanSpec.model_validate({"file": str(tmp_path / "map.yaml")}))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[0, 0, 0]", "[0, 0, 30]", "map.yaml: yaw is 30 rad: degrees?"),
        ("0.1", "5", "map.yaml: resolution is 5 m: centimetres?"),
        ("[0, 0, 0]", "[0, 0, 0, 0, 0, 1]", "map.yaml: origin has 6 numbers; it is x, y"),
    ],
)
def test_numbers_of_a_map_in_other_units(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, old: str, new: str, message: str
) -> None:
    _image(tmp_path / "map.png")
    text = "image: map.png\nresolution: 0.1\norigin: [0, 0, 0]\n".replace(old, new)
    (tmp_path / "map.yaml").write_text(text, "utf-8")
    if "6 numbers" in message:
        with pytest.raises(InputError, match=message):
            _plan(file=str(tmp_path / "map.yaml"))
        return
    _plan(file=str(tmp_path / "map.yaml"))
    assert caplog.messages == [message]


# --------------------------------------------------------------- properties of other programs
@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("Level", (0, 1)),
        ("floor", ("EG", "1. OG")),
        ("floor", (0, 1)),
        ("level_id", ("a1", "b2")),
        ("STOREY", ("0", "1")),
    ],
)
def test_storeys_by_other_names(tmp_path: Path, name: str, values: tuple[Any, Any]) -> None:
    upper = "POLYGON ((20 0, 30 0, 30 5, 20 5, 20 0))"
    path = _geojson(tmp_path, (HALL, {name: values[0]}), (upper, {name: values[1]}))
    with pytest.raises(InputError, match="there are 2 storeys in it"):
        _plan(file=path)
    assert _plan(file=path, level=values[1]).walls[:, 0].min() == 20.0


def test_a_covering_of_the_floor_is_no_storey(tmp_path: Path) -> None:
    upper = "POLYGON ((9 0, 30 0, 30 5, 9 5, 9 0))"
    path = _geojson(tmp_path, (HALL, {"floor": "wood"}), (upper, {"floor": "concrete"}))
    assert _plan(file=path).walls[:, 0].max() == 30.0


def test_properties_in_capitals(tmp_path: Path) -> None:
    block = "POLYGON ((2 1, 4 1, 4 2, 2 2, 2 1))"
    path = _geojson(tmp_path, (HALL, {}), (block, {"KIND": "obstacle", "HEIGHT": 1.0}))
    assert _solid(_plan(file=path)).area == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("name", "value"), [("indoor", "wall"), ("type", "Column"), ("class", "inner walls")]
)
def test_solids_by_another_name_are_told(
    tmp_path: Path, caplog: Log, name: str, value: str
) -> None:
    block = "POLYGON ((2 1, 4 1, 4 2, 2 2, 2 1))"
    path = _geojson(tmp_path, (HALL, {"indoor": "room"}), (block, {name: value}))
    _plan(file=path)
    assert f"taken for floor: 1 feature(s) with '{name}: {value}'" in caplog.text
    caplog.clear()
    _plan(file=path, polygons="obstacles")
    assert "taken for floor" not in caplog.text


def test_polygons_on_the_floor_of_others_are_told(tmp_path: Path, caplog: Log) -> None:
    block = "POLYGON ((2 1, 4 1, 4 2, 2 2, 2 1))"
    path = _geojson(tmp_path, (HALL, {"group": "boundary"}), (block, {"group": "objects"}))
    assert not _solid(_plan(file=path)).area
    assert "1 of its polygons lie within others and change nothing" in caplog.text
    caplog.clear()
    _plan(file=path, polygons="obstacles")
    _plan(file=_geojson(tmp_path, (HALL, {}), (block, {"kind": "obstacle"})))
    _plan(file=_geojson(tmp_path, (HALL, {}), (block, {"kind": "walkable"})))
    assert "change nothing" not in caplog.text


@pytest.mark.parametrize("where", ["feature", "type", "indoor"])
def test_doors_that_are_lines_are_no_walls(tmp_path: Path, caplog: Log, where: str) -> None:
    door = {} if where == "feature" else {where: "Door"}
    path = _geojson(tmp_path, (HALL, {}), ("LINESTRING (4 1, 4 4)", door))
    if where == "feature":  # as in IMDF
        content = json.loads(Path(path).read_text())
        content["features"][1]["feature_type"] = "opening"
        Path(path).write_text(json.dumps(content))
    assert not _plan(file=path).solids
    assert "left out: 1 feature(s) that are lines of doors or openings" in caplog.text


def test_a_walkable_line_is_no_wall(tmp_path: Path, caplog: Log) -> None:
    path = _geojson(tmp_path, (HALL, {}), ("LINESTRING (4 1, 4 4)", {"kind": "walkable"}))
    assert not _plan(file=path).solids
    assert "left out: 1 feature(s) of kind 'walkable' that are lines" in caplog.text


@pytest.mark.parametrize("north", [0.0, 6_124_000.0])
def test_metres_of_web_mercator(tmp_path: Path, north: float) -> None:
    box = shapely.geometry.mapping(shapely.box(1_280_000, north, 1_280_010, north + 10))
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}
    file = tmp_path / "plan.geojson"
    feature = {"type": "Feature", "properties": {}, "geometry": box}
    file.write_text(json.dumps({"type": "FeatureCollection", "crs": crs, "features": [feature]}))
    where = (-1_280_000.0, -north)
    if north:
        with pytest.raises(InputError, match=r"in which a metre is 1\.50 long there"):
            _plan(file=str(file), origin=where)
    else:
        assert len(_plan(file=str(file), origin=where).walls) == 4
