"""Drawings that a CAD library writes: what is read, and that all that is not is named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.errors import InputError
from tests.plugins.environments.test_floor_plan_dxf import plan, solid

ezdxf = pytest.importorskip("ezdxf", reason="the extra dxf is not installed")

Log = pytest.LogCaptureFixture
_METRES = 6


class Drawn:
    """A hall of 20 m × 12 m and what a test adds."""

    def __init__(self, version: str = "R2010", unit: int = _METRES, *, hall: bool = True) -> None:
        self.file = ezdxf.new(version)
        self.file.units = unit
        self.model = self.file.modelspace()
        if hall:
            self.box(0, 0, 20, 12)

    def box(self, x0: float, y0: float, x1: float, y1: float, into: Any = None, **how: Any) -> None:
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        target = self.model if into is None else into
        if self.file.dxfversion == "AC1009":
            target.add_polyline2d(corners, close=True, dxfattribs=how)
        else:
            target.add_lwpolyline(corners, close=True, dxfattribs=how)

    def saved(self, tmp_path: Path, **how: Any) -> str:
        path = tmp_path / "plan.dxf"
        self.file.saveas(path, **how)
        return str(path)


def filled(parts: Any, x: float, y: float) -> bool:
    return bool(solid(parts).contains(shapely.Point(x, y)))


@pytest.mark.parametrize("version", ["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"])
@pytest.mark.parametrize("written", ["asc", "bin"])
def test_versions(tmp_path: Path, version: str, written: str) -> None:
    drawn = Drawn(version)
    drawn.box(5, 5, 6, 6)
    parts = plan(drawn.saved(tmp_path, fmt=written))
    assert parts.walls.max() == pytest.approx(20.0)
    assert filled(parts, 5.5, 5.5)
    assert not filled(parts, 7.0, 5.5)


@pytest.mark.parametrize(("code", "metres"), [(1, 0.0254), (10, 0.9144), (14, 0.1), (15, 10.0)])
def test_units(tmp_path: Path, code: int, metres: float) -> None:
    drawn = Drawn(unit=code, hall=False)
    drawn.box(0, 0, 20 / metres, 12 / metres)
    drawn.model.add_circle((10 / metres, 6 / metres), 1 / metres)
    parts = plan(drawn.saved(tmp_path))
    assert parts.walls.max() == pytest.approx(20.0)
    assert solid(parts).area == pytest.approx(3.14159, rel=0.02)


def test_units_that_are_none_or_unknown(tmp_path: Path, caplog: Log) -> None:
    plan(Drawn(unit=0).saved(tmp_path))
    assert "declares no unit; its numbers count as m" in caplog.text
    with pytest.raises(InputError, match=r"INSUNITS 18\); write 'unit'"):
        plan(Drawn(unit=18).saved(tmp_path))
    assert plan(Drawn(unit=18).saved(tmp_path), unit="m").walls.max() == pytest.approx(20.0)


def test_bulges_are_arcs(tmp_path: Path) -> None:
    drawn = Drawn(hall=False)
    ends = [(0, 0, 0), (10, 0, 1), (10, 6, 0), (0, 6, 1)]
    drawn.model.add_lwpolyline(ends, format="xyb", close=True)
    walls = plan(drawn.saved(tmp_path)).walls
    assert (walls.min(), walls.max()) == (pytest.approx(-3.0), pytest.approx(13.0))


def test_blocks_in_blocks_are_scaled_turned_and_repeated(tmp_path: Path) -> None:
    drawn = Drawn()
    desk = drawn.file.blocks.new("DESK")
    drawn.box(0, 0, 1, 1, into=desk)
    room = drawn.file.blocks.new("ROOM")
    room.add_blockref("DESK", (1, 0))
    turned = {"xscale": 2.0, "yscale": 1.0, "rotation": 90.0}
    drawn.model.add_blockref("ROOM", (5, 5), dxfattribs=turned)  # x 4 to 5, y 7 to 9
    grid = {"row_count": 2, "column_count": 2, "row_spacing": 3.0, "column_spacing": 3.0}
    drawn.model.add_blockref("DESK", (12, 2), dxfattribs=grid)
    drawn.model.add_blockref("DESK", (10, 9), dxfattribs={"xscale": -1.0})  # x 9 to 10
    parts = plan(drawn.saved(tmp_path))
    assert solid(parts).area == pytest.approx(2.0 + 4.0 + 1.0)
    for x, y in ((4.5, 7.1), (4.5, 8.9), (12.5, 2.5), (15.5, 5.5), (9.5, 9.5)):
        assert filled(parts, x, y)


def test_layer_0_of_a_block_is_the_layer_of_the_insertion(tmp_path: Path) -> None:
    drawn = Drawn()
    drawn.box(0, 0, 1, 1, into=drawn.file.blocks.new("DESK"))
    drawn.model.add_blockref("DESK", (3, 3), dxfattribs={"layer": "FURN"})
    layers = {"0": "floor", "FURN": "obstacles"}
    assert filled(plan(drawn.saved(tmp_path), layers=layers), 3.5, 3.5)


def test_outlines_on_other_layers_and_filled_ones_are_holes(tmp_path: Path) -> None:
    drawn = Drawn()
    drawn.box(3, 3, 4, 4, layer="COLUMNS")
    drawn.box(6, 6, 8, 8)
    drawn.model.add_hatch().paths.add_polyline_path([(6, 6), (8, 6), (8, 8), (6, 8)])
    assert solid(plan(drawn.saved(tmp_path))).area == pytest.approx(1.0 + 4.0)


def test_hatches_with_islands(tmp_path: Path) -> None:
    drawn = Drawn()
    hatch = drawn.model.add_hatch(dxfattribs={"layer": "WALLS"})
    for low, high in ((5, 9), (6, 8)):
        corners = [(low, low), (high, low), (high, high), (low, high)]
        hatch.paths.add_polyline_path(corners, is_closed=True)
    parts = plan(drawn.saved(tmp_path), layers={"0": "floor", "WALLS": "obstacles"})
    assert solid(parts).area == pytest.approx(16.0 - 4.0)


def test_closed_curves(tmp_path: Path) -> None:
    drawn = Drawn()
    drawn.model.add_ellipse((5, 6), (2, 0), 0.5)
    drawn.model.add_circle((-15, 6), 1, dxfattribs={"extrusion": (0, 0, -1)})  # mirrored: at x 15
    spline = drawn.model.add_spline()
    spline.set_closed([(9, 5, 0), (11, 5, 0), (11, 7, 0), (9, 7, 0)])
    drawn.model.add_solid([(1, 1), (2, 1), (1, 2), (2, 2)])
    parts = plan(drawn.saved(tmp_path))
    for x, y in ((5, 6), (15, 6), (10, 6), (1.5, 1.5)):
        assert filled(parts, x, y)
    # ellipse, circle, and a uniform cubic B-spline around a square of 4 m², integrated; a square
    assert solid(parts).area == pytest.approx(6.2832 + 3.1416 + 2.7111 + 1.0, abs=0.07)


def _missing_block(drawn: Drawn) -> None:
    drawn.model.add_blockref("NOTHERE", (1, 1))


def _other_drawing(drawn: Drawn) -> None:
    drawn.file.add_xref_def("other.dxf", "OTHER")
    drawn.model.add_blockref("OTHER", (1, 1))


def _frozen(drawn: Drawn) -> None:
    drawn.file.layers.add("X").freeze()
    drawn.box(0, 0, 1, 1, into=drawn.file.blocks.new("DESK"), layer="FURN")
    drawn.model.add_blockref("DESK", (3, 3), dxfattribs={"layer": "X"})


def _off(drawn: Drawn) -> None:
    drawn.file.layers.add("OFF").off()
    drawn.box(3, 3, 4, 4, layer="OFF")


def _dimension(drawn: Drawn) -> None:
    drawn.model.add_linear_dim(base=(0, 2), p1=(0, 0), p2=(3, 0)).render()
    drawn.model.add_leader([(1, 1), (3, 3)])


def _standing(drawn: Drawn) -> None:
    drawn.model.add_circle((4, 4, 0), 1, dxfattribs={"extrusion": (1, 0, 0)})


def _without_length(drawn: Drawn) -> None:
    drawn.model.add_line((5, 5), (5, 5))
    drawn.model.add_line((6, 6, 0), (6, 6, 3))


def _surfaces(drawn: Drawn) -> None:
    drawn.model.add_polymesh((3, 3))
    drawn.model.add_3dface([(5, 5), (7, 5), (7, 7), (5, 7)])


@pytest.mark.parametrize(("add", "expected"), [
    (_missing_block, ["1 inserted block 'NOTHERE', which is not in the file"]),
    (_other_drawing, ["1 other drawing 'OTHER', which it refers to"]),
    (_frozen, ["1 block 'DESK' on layer 'X', which is frozen"]),
    (_off, ["1 on layer 'OFF', which is off"]),
    (_dimension, ["1 DIMENSION entities", "1 LEADER entities"]),
    (_standing, ["1 CIRCLE entities that stand upright"]),
    (_without_length, ["2 LINE entities that are damaged or have no length"]),
    (_surfaces, ["1 POLYLINE entities that are surfaces", "1 3DFACE entities"]),
    (lambda d: d.model.add_line((1, 1), (9, 9), dxfattribs={"invisible": 1}), ["1 invisible LINE"]),
    (lambda d: d.file.layout("Layout1").add_line((0, 0), (9, 9)), ["1 in the paper space"]),
    (lambda d: d.model.add_mtext("Hall"), ["1 MTEXT entities"]),
])  # fmt: skip
def test_what_is_left_out_is_named(
    tmp_path: Path, caplog: Log, add: Callable[[Drawn], None], expected: list[str]
) -> None:
    drawn = Drawn()
    add(drawn)
    parts = plan(drawn.saved(tmp_path))
    assert len(parts.walls) == 4
    assert not len(parts.solids)
    for text in expected:
        assert text in caplog.text


def test_widths_are_left_out(tmp_path: Path, caplog: Log) -> None:
    drawn = Drawn()
    drawn.box(3, 3, 4, 4, const_width=0.5)
    assert solid(plan(drawn.saved(tmp_path))).area == pytest.approx(1.0)
    assert "1 widths of LWPOLYLINE entities" in caplog.text


def test_a_drawing_of_sheets_alone_is_refused(tmp_path: Path) -> None:
    drawn = Drawn(hall=False)
    drawn.box(0, 0, 9, 9, into=drawn.file.layout("Layout1"))
    with pytest.raises(InputError, match="nothing in it can be read: it has 1 in the paper space"):
        plan(drawn.saved(tmp_path))


def test_blocks_that_contain_themselves_are_refused(tmp_path: Path) -> None:
    drawn = Drawn()
    for one, other in (("A", "B"), ("B", "A")):
        drawn.file.blocks.new(one).add_blockref(other, (1, 1))
    drawn.model.add_blockref("A", (0, 0))
    with pytest.raises(InputError, match="its blocks contain each other: 'A'"):
        plan(drawn.saved(tmp_path))


def test_texts_before_2007_are_read_in_their_code_page(tmp_path: Path) -> None:
    drawn = Drawn("R2000")
    drawn.file.encoding = "cp1251"
    drawn.box(3, 3, 4, 4, layer="Стены")
    layers = {"0": "floor", "Стены": "obstacles"}
    assert filled(plan(drawn.saved(tmp_path), layers=layers), 3.5, 3.5)


@pytest.mark.parametrize("part", [0.0, 0.01, 0.25, 0.5, 0.75, 0.9, 0.995])
@pytest.mark.parametrize("written", ["asc", "bin"])
def test_files_that_are_cut_off_are_refused(tmp_path: Path, part: float, written: str) -> None:
    path = Path(Drawn().saved(tmp_path, fmt=written))
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(InputError, match="is not a DXF drawing, or is cut off or damaged"):
        plan(str(path))


@pytest.mark.parametrize("bad", ["nan", "abc", ""])
def test_numbers_that_are_none_are_refused(tmp_path: Path, bad: str) -> None:
    path = Path(Drawn().saved(tmp_path))
    path.write_text(path.read_text().replace("20.0\n", f"{bad}\n"))
    with pytest.raises(InputError, match="is not a DXF drawing, or is cut off or damaged"):
        plan(str(path))


def test_entities_of_other_programs_are_named(tmp_path: Path, caplog: Log) -> None:
    drawn = Drawn()
    drawn.model.add_line((1, 1), (2, 2))
    path = Path(drawn.saved(tmp_path))
    text = path.read_text()
    assert "\nLINE\n" in text
    path.write_text(text.replace("\nLINE\n", "\nAEC_WALL\n"))
    assert not len(plan(str(path)).solids)
    assert "left out: 1 AEC_WALL entities" in caplog.text
