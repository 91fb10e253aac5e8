"""Shapes of a drawing, in pixels (x to the right, y down); their role determines their style."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from crowdbot.core.types.arrays import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """A line, or an area if closed. ``inside``: clipped at the map's border."""

    points: tuple[Point, ...]
    role: str
    closed: bool = False
    inside: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """A disc; ``about`` is its tooltip."""

    centre: Point
    radius: float
    role: str
    about: str = ""
    inside: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """A line of text; ``anchor`` is start, middle or end; turned counter-clockwise, degrees."""

    at: Point
    text: str
    role: str
    size: float = 12.0
    anchor: str = "start"
    turned: float = 0.0


Shape = Path | Disc | Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawing:
    """Shapes in the order in which they are painted.

    Attributes:
        width, height: px.
        map_box: x, y, width and height of the part that shows the world, px.
        facts: name -> text, the drawing's content as text.
    """

    width: float
    height: float
    map_box: tuple[float, float, float, float]
    title: str
    shapes: tuple[Shape, ...]
    facts: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, slots=True, kw_only=True)
class Style:
    """Drawing style of a role: colour names of `LIGHT` and `DARK`, widths in px."""

    fill: str = ""
    opacity: float = 1.0
    stroke: str = ""
    width: float = 1.0
    dash: tuple[float, ...] = ()
    bold: bool = False


LIGHT = {
    "page": "#f3f1ec", "floor": "#fffefb", "grid": "#f0ede6", "grid_strong": "#e2ded4",
    "ink": "#22262b", "muted": "#6a6f76", "wall": "#3a3f46", "zone": "#8a8577",
    "portal": "#8459a8", "robot": "#f08a24", "robot_edge": "#3d2205", "goal": "#2e9e5b",
    "sensor": "#00929c", "person_edge": "#2b4a68", "arrow": "#2b4a68", "route": "#b0518f",
    "thought": "#b25a00",
}  # fmt: skip
DARK = {
    "page": "#14171b", "floor": "#1c2025", "grid": "#23282e", "grid_strong": "#313840",
    "ink": "#e8e6e1", "muted": "#99a0a8", "wall": "#b9c0c8", "zone": "#8f8b80",
    "portal": "#b48be0", "robot": "#ff9f40", "robot_edge": "#2a1600", "goal": "#4cc77f",
    "sensor": "#35d0d8", "person_edge": "#0f1b28", "arrow": "#9fc3e6", "route": "#e08cc2",
    "thought": "#ffb454",
}  # fmt: skip

#: Colours of people from slow to fast, the same in light and dark mode.
SPEEDS = ("#345a84", "#4a7097", "#6186aa", "#7a9dbd", "#94b3ce", "#afc8dd", "#c9dcec", "#e2eef8")
for _palette in (LIGHT, DARK):
    _palette.update({f"speed_{i}": colour for i, colour in enumerate(SPEEDS)})

STYLES = {
    "page": Style(fill="page"),
    "floor": Style(fill="floor"),
    "grid": Style(stroke="grid"),
    "grid-strong": Style(stroke="grid_strong"),
    "frame": Style(stroke="grid_strong"),
    "zone": Style(fill="zone", opacity=0.09, stroke="zone", width=1.0, dash=(2.0, 3.0)),
    "portal": Style(fill="portal", opacity=0.16, stroke="portal", width=1.2),
    "goal-area": Style(fill="route", opacity=0.12, stroke="route", width=1.2, dash=(4.0, 3.0)),
    "spawn": Style(fill="arrow", opacity=0.07, stroke="arrow", width=1.0, dash=(1.0, 3.0)),
    "goal": Style(fill="goal", opacity=0.14, stroke="goal", width=2.0, dash=(7.0, 4.0)),
    "wall": Style(stroke="wall", width=4.0),
    "wall-robot": Style(stroke="robot", width=2.5, dash=(9.0, 5.0)),
    "wall-crowd": Style(stroke="arrow", width=2.5, dash=(3.0, 4.0)),
    "torus": Style(stroke="portal", width=2.0, dash=(10.0, 4.0, 2.0, 4.0)),
    "pillar": Style(fill="wall"),
    "sensor": Style(fill="sensor", opacity=0.02, stroke="sensor", width=0.5, dash=(3.0, 5.0)),
    "group": Style(stroke="arrow", width=5.0, opacity=0.35),
    "route": Style(stroke="route", width=1.0, dash=(3.0, 3.0)),
    "mesh": Style(stroke="zone", width=1.0, dash=(1.5, 2.5)),
    "mesh-link": Style(stroke="zone", width=0.5, opacity=0.25),
    "solid": Style(fill="wall"),
    "solid-low": Style(fill="wall", opacity=0.35, stroke="wall", width=1.0),
    "solid-raised": Style(fill="wall", opacity=0.1, stroke="wall", width=1.5, dash=(5.0, 3.0)),
    "left-out": Style(fill="route", opacity=0.25, stroke="route", width=1.5, dash=(2.0, 2.0)),
    "robot-goal": Style(fill="goal", stroke="floor", width=1.5),
    "route-end": Style(fill="route", stroke="floor", width=1.0),
    **{
        f"person-{i}": Style(fill=f"speed_{i}", stroke="person_edge", width=1.0)
        for i in range(len(SPEEDS))
    },
    **{f"ramp-{i}": Style(fill=f"speed_{i}") for i in range(len(SPEEDS))},
    "wanted": Style(stroke="goal", width=3.0),
    "involved": Style(stroke="route", width=2.5),
    "arrow": Style(stroke="arrow", width=1.4),
    "thought": Style(stroke="thought", width=2.0),
    "thought-dot": Style(fill="thought"),
    "robot": Style(fill="robot", stroke="robot_edge", width=1.8),
    "robot-nose": Style(stroke="robot_edge", width=2.2),
    "scale": Style(stroke="ink", width=2.5),
    "text": Style(fill="ink"),
    "text-strong": Style(fill="ink", bold=True),
    "text-muted": Style(fill="muted"),
    "text-zone": Style(fill="zone", bold=True),
    "text-portal": Style(fill="portal", bold=True),
    "text-goal": Style(fill="goal", bold=True),
    "text-route": Style(fill="route", bold=True),
    "text-thought": Style(fill="thought", bold=True),
    "text-robot": Style(fill="robot", bold=True),
}
