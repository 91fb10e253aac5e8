"""Floors: words that make sense, and the geometry they become."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from crowdbot.plugins.environments.floor import FLOOR, BlockSpec, FloorSpec
from crowdbot.plugins.environments.place_build import build

AREA = {"x": (0.0, 20.0), "y": (-5.0, 5.0)}
SQUARE = {"corners": [[0, 0], [4, 0], [4, 4], [0, 4]]}
HOLE = [[1, 1], [2, 1], [2, 2], [1, 2]]


def _floor(**fields: Any) -> FloorSpec:
    return FloorSpec.model_validate({"area": AREA, **fields})


def test_a_plain_floor_is_fenced() -> None:
    parts = build(_floor())
    assert parts.walls.tolist() == [
        [0, -5, 20, -5], [20, -5, 20, 5], [20, 5, 0, 5], [0, 5, 0, -5]
    ]  # fmt: skip
    assert np.all(parts.stops_robot)
    assert np.all(parts.stops_crowd)
    assert parts.periodic_boundary is None
    assert parts.solids == ()


@pytest.mark.parametrize(("border", "torus"), [("open", None), ("torus", (0.0, 20.0, -5.0, 5.0))])
def test_other_borders(border: str, torus: object) -> None:
    parts = build(_floor(border=border))
    assert parts.walls.shape == (0, 4)
    assert parts.wall_heights.shape == (0, 2)
    assert parts.periodic_boundary == torus


def _inside(walls: Any, x: float, y: float) -> float:
    """How often the edges wind around a point: -1 for a solid, whose free side is outside."""
    a = np.arctan2(walls[:, 1] - y, walls[:, 0] - x)
    b = np.arctan2(walls[:, 3] - y, walls[:, 2] - x)
    return float(np.sum((b - a + np.pi) % (2 * np.pi) - np.pi) / (2 * np.pi))


def test_walls_and_blocks_are_solid() -> None:
    parts = build(
        _floor(
            border="open",
            walls={"screen": {"start": [3.0, 0.0], "end": [6.0, 4.0], "thickness": 0.2}},
            blocks={"kiosk": {"corners": [[10.0, 0.0], [12.0, 0.0], [11.0, 2.0]]}},
            wall_height=1.2,
        )
    )
    screen, kiosk = parts.walls[:4], parts.walls[4:]
    assert np.hypot(*(screen[:, 2:] - screen[:, :2]).T) == pytest.approx([5.0, 0.2, 5.0, 0.2])
    assert _inside(screen, 4.5, 2.0) == pytest.approx(-1.0)
    assert _inside(screen, 4.5 + 0.11 * 0.8, 2.0 - 0.11 * 0.6) == pytest.approx(0.0, abs=1e-9)
    assert _inside(kiosk, 11.0, 0.5) == pytest.approx(-1.0)
    assert not np.any(parts.stops_robot)  # the solids do
    assert [len(s) for s in parts.solids] == [4, 3]
    assert parts.solid_heights.tolist() == [[0.0, 1.2]] * 2
    for solid in parts.solids:  # counter-clockwise
        x, y = solid.T
        assert np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0


def test_pillars_zones_and_portals() -> None:
    parts = build(
        _floor(
            pillars={"a": {"x": 5.0, "y": 1.0, "radius": "40 cm"}},
            zones={"start": {"x": [0, 2.0], "y": [-1.0, 1.0]}},
            portals={"in": {"x": [-1.0, 0.0], "y": [-1.0, 1.0]}},
        )
    )
    assert parts.pillars.tolist() == [[5.0, 1.0, 0.4]]
    assert parts.pillar_heights.tolist() == [[0.0, 2.5]]
    assert parts.zones["start"].tolist() == [[0, -1], [2, -1], [2, 1], [0, 1]]
    assert parts.portals == {"in": (-1.0, 0.0, -1.0, 1.0)}


@given(st.integers(3, 20), st.floats(0, 6.28), st.booleans())
def test_every_regular_polygon_is_a_block(count: int, turn: float, clockwise: bool) -> None:
    angles = [turn + 2 * math.pi * k / count * (-1 if clockwise else 1) for k in range(count)]
    block = BlockSpec(corners=tuple((math.cos(a), math.sin(a)) for a in angles))
    x, y = np.array(block.corners).T
    assert np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"walls": {"w": {"start": [1, 1], "end": [1, 1]}}}, "must differ"),
        ({"walls": {"w": {"start": [1, 1], "end": [21, 1]}}}, "wall 'w' leaves the area"),
        ({"walls": {"w": {"start": [1, 1], "end": [2, 1], "thickness": 0.0}}}, "greater than 0"),
        ({"pillars": {"p": {"x": 1.0, "y": 6.0, "radius": 0.3}}}, "pillar 'p' leaves the area"),
        ({"blocks": {"b": {"corners": [[1, 1], [2, 1]]}}}, "at least 3"),
        ({"blocks": {"b": {"corners": [[1, 1], [2, 1], [3, 1]]}}}, "must have an area"),
        ({"blocks": {"b": {"corners": [[1, 1], [1, 1], [3, 1], [2, 2]]}}}, "twice in a row"),
        (
            {"blocks": {"b": {"corners": [[1, 1], [3, 3], [3, 1], [1, 3]]}}},
            "must not cross or touch",
        ),
        ({"blocks": {"b": {"corners": [[1, 1], [3, 3], [3, 0], [1, 3]]}}}, "must not cross"),
        ({"blocks": {"b": SQUARE | {"holes": [[[5, 5], [6, 5], [6, 6]]]}}}, "outside of the out"),
        ({"blocks": {"b": SQUARE | {"holes": [[[1, 0], [2, 0], [2, 1]]]}}}, "touches the outline"),
        ({"blocks": {"b": SQUARE | {"holes": [HOLE, HOLE]}}}, "touches the outline or another"),
        ({"blocks": {"b": SQUARE | {"base": 1.0, "height": 0.5}}}, "must be below height"),
        ({"blocks": {"b": SQUARE | {"base": 3.0}}}, "'b' has base 3 m"),
        ({"pillars": {"p": {"x": 1.0, "y": 1.0, "radius": 0.3, "base": -1}}}, "below the floor"),
        ({"zones": {"z": {"x": [19.0, 21.0], "y": [0.0, 1.0]}}}, "zone 'z' leaves the area"),
        ({"border": "moat"}, "'walls', 'open' or 'torus'"),
        ({"wals": {}}, "Extra inputs"),
    ],
)
def test_what_makes_no_sense_is_refused(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        _floor(**fields)


def test_a_star_that_always_turns_left_is_no_block() -> None:
    star = [(math.cos(a), math.sin(a)) for a in np.arange(5) * 4 * math.pi / 5]
    with pytest.raises(ValidationError, match="must not cross or touch"):
        BlockSpec(corners=tuple(star))


def test_each_thing_has_its_own_heights() -> None:
    parts = build(
        _floor(
            walls={
                "low": {"start": [3, 0], "end": [6, 0], "height": "30 cm"},
                "gate": {"start": [3, 2], "end": [6, 2], "base": "30 cm", "height": "110 cm"},
            },
            blocks={"high": {"corners": [[1, 1], [2, 1], [2, 2]], "base": 1.0}},
            pillars={"p": {"x": 9.0, "y": 1.0, "radius": 0.2, "base": 0.2, "height": 0.4}},
        )
    )
    assert parts.solid_heights.tolist() == [[0.0, 0.3], [0.3, 1.1], [1.0, 2.5]]
    assert parts.wall_heights[4:].tolist() == [[0.0, 0.3]] * 4 + [[0.3, 1.1]] * 4 + [[1.0, 2.5]] * 3
    assert parts.pillar_heights.tolist() == [[0.2, 0.4]]


def test_heights_that_nobody_wrote_are_not_in_a_document() -> None:
    plain = BlockSpec.model_validate(SQUARE).model_dump(mode="json")
    assert set(plain) == {"corners"}
    assert set(BlockSpec.model_validate(SQUARE | {"base": 1.0}).model_dump()) == {"corners", "base"}


L_SHAPE = [[0, 0], [6, 0], [6, 2], [2, 2], [2, 4], [0, 4]]


@pytest.mark.parametrize("corners", [L_SHAPE, L_SHAPE[::-1]])
def test_a_concave_block_is_made_of_convex_solids(corners: list[list[int]]) -> None:
    parts = build(_floor(border="open", blocks={"b": {"corners": corners}}))
    assert sum(_area(s) for s in parts.solids) == pytest.approx(16.0)
    assert len(parts.solids) == 2
    assert len(parts.walls) == 6  # its own sides, none within
    assert _inside(parts.walls, 1.0, 3.0) == pytest.approx(-1.0)
    assert _inside(parts.walls, 4.0, 3.0) == pytest.approx(0.0, abs=1e-9)


def test_a_block_with_a_courtyard() -> None:
    parts = build(_floor(border="open", blocks={"b": SQUARE | {"holes": [HOLE]}}))
    assert sum(_area(s) for s in parts.solids) == pytest.approx(15.0)
    assert len(parts.walls) == 8
    assert _inside(parts.walls, 0.5, 0.5) == pytest.approx(-1.0)
    assert _inside(parts.walls, 1.5, 1.5) == pytest.approx(0.0, abs=1e-9)


def _area(outline: Any) -> float:
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


@pytest.mark.parametrize("example", FLOOR.examples)
def test_the_examples_build(example: dict[str, Any]) -> None:
    parts = build(FloorSpec.model_validate(example))
    assert parts.walls.shape[1] == 4
