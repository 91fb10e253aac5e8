"""What a run needs from the robot and from the machine."""

from __future__ import annotations

from crowdbot.core.runs.request import Request
from crowdbot.core.sim.built_run import BuiltRun, build_run


def preflight(request: Request) -> BuiltRun:
    """Build the run; what this robot, or this machine, cannot give is refused before it is written.

    Raises:
        InputError: the robot lacks a sensor that the planner needs, its control mode does not
            fit its drive, or a sensor has the name of a frame that is not its own.
        PluginError: environment, robot or a sensor cannot be built.
        MissingLibraryError: colour images are wanted where they cannot be drawn.
    """
    built = build_run(request.scenario, request.registry, request.choice, request.record)
    cameras = (info.camera for info in built.infos.values())
    if any(camera is not None and camera.colour for camera in cameras):
        from crowdbot.core.sim.rendering import check_egl

        check_egl()
    return built
