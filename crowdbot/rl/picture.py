"""A picture of a world from above, as an array of pixels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.contact.robot_contact import R_YAW
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.types.arrays import Array

if TYPE_CHECKING:
    from crowdbot.rl.rollout import Rollout

#: Size of a picture, pixels, and width of what it shows, m.
_WIDTH, _HEIGHT, _SHOWN = 640, 480, 16.0


def picture(rollout: Rollout, w: int) -> NDArray[np.uint8]:
    """Return (H, W, 3) pixels of one world, with the robot in the middle and x to the right."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Polygon

    world = rollout.world(w)
    plan = world.blueprint
    figure = Figure(figsize=(_WIDTH / 100, _HEIGHT / 100), dpi=100)
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    x, y = world.robots[0, :2]
    half = 0.5 * _SHOWN * _HEIGHT / _WIDTH
    axes.set_xlim(x - 0.5 * _SHOWN, x + 0.5 * _SHOWN)
    axes.set_ylim(y - half, y + half)
    for task in world.tasks:
        axes.add_patch(Polygon(task.goal_zone, color="#cdeccd"))
    axes.add_collection(LineCollection(list(plan.parts.walls.reshape(-1, 2, 2)), colors="#222222"))
    for outline in plan.parts.solids:
        axes.add_patch(Polygon(outline, color="#777777"))
    for px, py, radius in plan.parts.pillars:
        axes.add_patch(Circle((px, py), radius, color="#777777"))
    people: Any = rollout.people()[w]
    for px, py, _, _, radius in people[np.isfinite(people[:, 0])]:
        axes.add_patch(Circle((px, py), radius, color="#4477aa"))
    for row, model in zip(world.robots, plan.models, strict=True):
        axes.add_patch(Polygon(_outline(row, model), color="#cc3311"))
        tip = row[:2] + 0.5 * np.array([np.cos(row[R_YAW]), np.sin(row[R_YAW])])
        axes.plot([row[0], tip[0]], [row[1], tip[1]], color="#cc3311")
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _outline(row: Array, model: Any) -> Array:
    body = footprint_of_model(model)
    outline = body.outline(row[0], row[1], row[R_YAW])
    if len(outline):
        return outline
    turn = np.linspace(0.0, 2.0 * np.pi, 24)
    return row[:2] + body.radius * np.column_stack([np.cos(turn), np.sin(turn)])
