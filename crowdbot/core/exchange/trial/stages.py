"""Known stages of the original's public scenes, converted to crowdbot's frame.

Crowdbot's x is Unity's Z, its y is -X. Other stages are made of the trial's own obstacles.
"""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.exchange.scene import Data


def _box(x: tuple[float, float], z: tuple[float, float]) -> Data:
    """Return the block over ranges of Unity's X and Z."""
    corners = ((z[0], x[0]), (z[0], x[1]), (z[1], x[1]), (z[1], x[0]))
    return {"corners": [[round(a, 6), round(-b, 6)] for a, b in corners]}


def _wall(start: tuple[float, float], end: tuple[float, float]) -> Data:
    """Return a wall 0.25 m thick between two points of Unity's X and Z."""
    return {"start": [start[1], -start[0]], "end": [end[1], -end[0]], "thickness": 0.25}


def _square(x: float, z: float, side: float) -> Data:
    return _box((x - side / 2, x + side / 2), (z - side / 2, z + side / 2))


#: Two rooms joined by a passage; doors are closed.
_ROOMS: Data = {
    "kind": "floor",
    "border": "open",
    "wall_height": 3,
    "walls": {
        "north": _wall((-12, 7.2), (3, 7.2)), "east": _wall((3, 7.2), (3, -1.8)),
        "west": _wall((-12, 7.2), (-12, -1.8)), "to_passage_west": _wall((-12, -1.8), (-6, -1.8)),
        "to_passage_east": _wall((-3, -1.8), (3, -1.8)),
        "passage_west": _wall((-6, -1.8), (-6, -4.8)),
        "passage_east": _wall((-3, -1.8), (-3, -4.8)),
        "south_room_west": _wall((-9, -4.8), (-6, -4.8)),
        "south_room_east": _wall((-3, -4.8), (0, -4.8)),
        "south_west": _wall((-9, -4.8), (-9, -13.8)), "south_east": _wall((0, -4.8), (0, -13.8)),
        "south": _wall((-9, -13.8), (0, -13.8)),
    },
    "blocks": {
        "corner_1": _square(-11.75, -1.56, 1.06), "corner_2": _square(2.75, -1.56, 1.06),
        "corner_3": _square(-11.75, 6.94, 1.06), "corner_4": _square(2.75, 6.94, 1.06),
        "passage_1": _square(-6, -1.81, 0.81), "passage_2": _square(-3, -1.81, 0.81),
        "door_1": _square(-5.5, 6.94, 0.56), "door_2": _square(-3.5, 6.94, 0.56),
    },
    "area": {"x": [-15, 9], "y": [-4, 13]},
}  # fmt: skip
_PLANE: Data = {"kind": "floor", "border": "open", "area": {"x": [-50, 50], "y": [-50, 50]}}
#: Draft -> environment, and what is known about it.
STAGES: Mapping[str, tuple[Data, str]] = {
    "BigPlane": (_PLANE, ""),
    "Plane": (_PLANE, "its size is not published: 100 m x 100 m"),
    "Rooms": (_ROOMS, "walls and pillars of the public scene; doors are closed, windows are walls"),
    "Paris": (
        {"kind": "floor", "border": "open", "area": {"x": [-58.1, 41.9], "y": [-53.5, 46.5]}},
        "its houses are not published and the original's crowd does not know them: an open floor",
    ),
    "Crowdbot_challenge": (
        {"kind": "floor", "border": "walls", "area": {"x": [-5, 5], "y": [-25, 25]}},
        "the corridor of the challenge, 50 m x 10 m, along our y",
    ),
}
