"""Build robots from scenarios."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from functools import cache

from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.check import check_model
from crowdbot.core.types.robot import DifferentialDrive, HolonomicDrive, RobotModel
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.spec.component_specs import RobotSpec
from crowdbot.errors import InputError

_LOG = logging.getLogger(__name__)
#: Drive -> supported control modes.
MODES: Mapping[type, tuple[str, ...]] = {
    DifferentialDrive: ("differential_drive", "force", "kinematic"),
    HolonomicDrive: ("force", "kinematic"),
}


@cache
def _tell(kind: str, note: str) -> None:
    """Log a note about a kind of robot as a warning."""
    _LOG.warning("%s: %s", kind, note)


def build_model(registry: Registry, spec: RobotSpec) -> RobotModel:
    """Build the model that a robot's spec describes.

    Raises:
        PluginError: the model cannot be built or is inconsistent.
    """
    return registry.build(spec, check_model)


def build_robot(registry: Registry, robot: Robot) -> RobotModel:
    """Build the model of a scenario's robot.

    Raises:
        PluginError: as `build_model`.
        InputError: its control mode does not fit its drive.
    """
    model = build_model(registry, robot.model)
    for note in model.notes:
        _tell(robot.model.kind, note)
    fitting = MODES[type(model.drive)]
    if robot.control not in fitting:
        raise InputError(
            f"control '{robot.control}' does not fit {robot.model.kind}, whose drive is "
            f"{'holonomic' if isinstance(model.drive, HolonomicDrive) else 'differential'}; "
            f"what does: {', '.join(fitting)}"
        )
    return model
