"""Floor plans from CAD: layers, units, curves, blocks; what is left out is named."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.errors import InputError
from crowdbot.plugin import EnvironmentParts
from crowdbot.plugins.environments.floor_plan import FloorPlanSpec
from crowdbot.plugins.environments.place_build import build

Log = pytest.LogCaptureFixture


def pairs(*items: object) -> str:
    return "".join(f"{item}\n" for item in items)


def entity(kind: str, layer: str, part: str, *items: object) -> str:
    return pairs(0, kind, 100, "AcDbEntity", 8, layer, 100, part, *items)


def outline(layer: str, *points: tuple[float, float]) -> str:
    corners = [item for x, y in points for item in (10, x, 20, y)]
    return entity(
        "LWPOLYLINE",
        layer,
        "AcDbPolyline",
        90,
        len(points),
        70,
        1,
        *corners,
    )


def box(layer: str, x0: float, y0: float, x1: float, y1: float) -> str:
    return outline(layer, (x0, y0), (x1, y0), (x1, y1), (x0, y1))


def line(layer: str, x0: float, y0: float, x1: float, y1: float) -> str:
    return entity("LINE", layer, "AcDbLine", 10, x0, 20, y0, 11, x1, 21, y1)


def drawing(tmp_path: Path, *entities: str, unit: int = 0, blocks: str = "") -> str:
    """A file as CAD programs write it, with the least that belongs to one."""
    header = pairs(0, "SECTION", 2, "HEADER", 9, "$ACADVER", 1, "AC1015",
                   9, "$INSUNITS", 70, unit, 0, "ENDSEC")  # fmt: skip
    body = pairs(0, "SECTION", 2, "ENTITIES") + "".join(entities) + pairs(0, "ENDSEC", 0, "EOF")
    inserted = pairs(0, "SECTION", 2, "BLOCKS") + blocks + pairs(0, "ENDSEC") if blocks else ""
    file = tmp_path / "plan.dxf"
    file.write_text(header + inserted + body, encoding="utf-8")
    return str(file)


def plan(file: str, **fields: Any) -> EnvironmentParts:
    return build(FloorPlanSpec.model_validate({"file": file, **fields}))


def solid(parts: EnvironmentParts) -> Any:
    return shapely.union_all([shapely.Polygon(s) for s in parts.solids])


HALL = box("FLOOR", 0, 0, 10, 6)


def test_layers_belong_to_dxf() -> None:
    with pytest.raises(ValueError, match="'layers' is for DXF files only"):
        FloorPlanSpec.model_validate({"wkt": "POLYGON ((0 0, 9 0, 9 5, 0 0))",
                                      "layers": {"A": "walls"}})  # fmt: skip
    plain = FloorPlanSpec.model_validate({"wkt": "POLYGON ((0 0, 9 0, 9 5, 0 0))"})
    assert "layers" not in plain.model_dump()


def test_without_ezdxf_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    monkeypatch.setitem(sys.modules, "ezdxf.filemanagement", None)
    with pytest.raises(InputError, match=r"pip install 'crowdbot\[dxf\]'"):
        plan(drawing(tmp_path, HALL))


class TestRead:
    """These need ezdxf."""

    @pytest.fixture(autouse=True)
    def _needs(self) -> None:
        pytest.importorskip("ezdxf")

    def test_outlines_are_floor_with_holes_and_lines_are_walls(self, tmp_path: Path) -> None:
        court = box("FLOOR", 4, 2, 6, 4)
        tree = box("FLOOR", 4.5, 2.5, 5.5, 3.5)
        file = drawing(tmp_path, HALL, court, tree, line("0", 2, 0, 2, 3))
        found = solid(plan(file))
        assert found.contains(shapely.Point(4.2, 3.0))  # the court is a hole
        assert not found.contains(shapely.Point(5.0, 3.0))  # what lies in it is floor again
        assert found.contains(shapely.Point(2.0, 1.5))
        assert not found.contains(shapely.Point(8.0, 3.0))

    def test_layers_say_what_is_what(self, tmp_path: Path, caplog: Log) -> None:
        file = drawing(
            tmp_path, HALL, box("Furniture", 1, 1, 2, 2), box("A-WALL-1", 5, 1, 9, 5),
            line("notes", 0, 0, 10, 6),
            entity("TEXT", "FLOOR", "AcDbText", 10, 1, 20, 1, 40, 1, 1, "x"),
        )  # fmt: skip
        parts = plan(file, layers={"floor": "floor", "FURN*": "obstacles", "a-wall*": "walls"})
        found = solid(parts)
        assert found.contains(shapely.Point(1.5, 1.5))
        assert found.contains(shapely.Point(5.0, 3.0))  # thin, along the outline
        assert not found.contains(shapely.Point(7.0, 3.0))
        assert "1 TEXT entities" in caplog.text
        assert "1 on layer 'notes', which 'layers' does not name" in caplog.text

    def test_a_layer_that_is_not_there_is_an_error(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"called 'FLOORS'; did you mean 'FLOOR'\?"):
            plan(drawing(tmp_path, HALL), layers={"FLOORS": "floor"})

    @pytest.mark.parametrize(("code", "scale"), [(4, 1000.0), (5, 100.0), (6, 1.0), (0, 1.0)])
    def test_the_declared_unit_counts(self, tmp_path: Path, code: int, scale: float) -> None:
        file = drawing(tmp_path, box("0", 0, 0, 10 * scale, 6 * scale), unit=code)
        walls = plan(file).walls
        assert walls.max() == pytest.approx(10.0)

    def test_a_written_unit_counts_more(self, tmp_path: Path, caplog: Log) -> None:
        file = drawing(tmp_path, box("0", 0, 0, 10, 6), unit=4)
        assert plan(file, unit="m").walls.max() == pytest.approx(10.0)
        assert "the drawing declares mm, the document says m" in caplog.text

    def test_curves_become_chords(self, tmp_path: Path) -> None:
        round_room = entity("CIRCLE", "0", "AcDbCircle", 10, 5, 20, 5, 40, 4)
        walls = plan(drawing(tmp_path, round_room)).walls.reshape(-1, 2)
        radius = [math.hypot(x - 5, y - 5) for x, y in walls]
        assert min(radius) == pytest.approx(4.0, abs=1e-6)
        middle = plan(drawing(tmp_path, round_room)).walls
        x, y = 0.5 * (middle[:, 0] + middle[:, 2]), 0.5 * (middle[:, 1] + middle[:, 3])
        assert (4.0 - ((x - 5) ** 2 + (y - 5) ** 2) ** 0.5).max() < 0.0101

    def test_blocks_are_read_each_time_they_are_inserted(self, tmp_path: Path) -> None:
        column = (
            entity(
                "BLOCK",
                "0",
                "AcDbBlockBegin",
                2,
                "COLUMN",
                70,
                0,
                10,
                0,
                20,
                0,
                3,
                "COLUMN",
            )
            + box("PILLARS", 0, 0, 1, 1)
            + entity("ENDBLK", "0", "AcDbBlockEnd")
        )
        inserts = [
            entity(
                "INSERT",
                "PILLARS",
                "AcDbBlockReference",
                2,
                "COLUMN",
                10,
                x,
                20,
                2,
            )
            for x in (2, 6)
        ]
        file = drawing(tmp_path, HALL, *inserts, blocks=column)
        found = solid(plan(file, layers={"FLOOR": "floor", "PILLARS": "obstacles"}))
        assert found.contains(shapely.Point(2.5, 2.5))
        assert found.contains(shapely.Point(6.5, 2.5))
        assert not found.contains(shapely.Point(4.5, 2.5))

    @pytest.mark.parametrize(("content", "why"), [
        (b"AutoCAD Binary DXF\r\n\x1a\0", "is not a DXF drawing, or is cut off"),
        (b"AC1027\0\0\0" + bytes(99), "is a DWG drawing; save it as DXF"),
        (b"PK\3\4" + bytes(99), "is not a DXF drawing.*Invalid group code"),
        (b"hello\nworld\n", "is not a DXF drawing"),
        (b"0\nSECTION\n2\nENT", "is not a DXF drawing|is empty|neither a floor"),
        (b"", "is not a DXF drawing|is empty"),
    ])  # fmt: skip
    def test_other_files_are_refused(self, tmp_path: Path, content: bytes, why: str) -> None:
        file = tmp_path / "plan.dxf"
        file.write_bytes(content)
        with pytest.raises(InputError, match=why):
            plan(str(file))
