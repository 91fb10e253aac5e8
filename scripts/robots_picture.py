"""Draws all robots side by side as a colour camera sees them: docs/images/robots/together.png."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from PIL import Image

from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.sensing.other_robots import OtherRobot
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.cameras.rendering import Renderer
from crowdbot.core.types.sensor import Pinhole
from crowdbot.plugin import Pose, RobotState
from scripts.draw_robots import FOLDER, KINDS

_SIZE, _VIEW = (1000, 400), math.radians(85.0)
_EYE, _PITCH = 1.4, math.radians(12.0)  # m, rad


def main() -> None:
    """Write the picture."""
    registry = discover(allow=())
    models = [build_model(registry, registry.find("robot", kind).spec()) for kind in KINDS]
    others = [OtherRobot(footprint_of_model(model), model.height) for model in models]
    scene = Scene([], [0.0, 2.5], [], [], robots=others)
    middle = 0.5 * (len(models) - 1)
    scene.show_robots(
        [Pose(3.2, 1.25 * (middle - k), math.radians(150.0)) for k in range(len(models))]
    )
    eye = RobotState(0, 0, 0, 0, 0, 0, 0, 0, 0, 0)
    scene.update(eye, np.zeros((0, 4)), np.zeros(0, dtype=np.bool_))
    (width, height), focal = _SIZE, 0.5 * _SIZE[0] / math.tan(0.5 * _VIEW)
    camera = Pinhole(width=width, height=height, focal=focal, colour=True)
    draw = Renderer(scene, camera, (0.0, 0.0, _EYE, 0.0), (0.0, _PITCH), models)
    Image.fromarray(draw(scene, Pose(0.0, 0.0, 0.0))).save(Path(FOLDER) / "together.png")


if __name__ == "__main__":
    main()
