"""Check the robot and the machine before a run."""

from __future__ import annotations

from crowdbot.core.planning.fleet_choice import check_robots
from crowdbot.core.runs.run import Request
from crowdbot.core.sim.built_run import BuiltRun, build_runs


def preflight(request: Request) -> dict[str, BuiltRun]:
    """Build the run of each robot, and refuse what the robot or this machine does not support.

    Raises:
        InputError: a robot has no planner, or lacks a sensor that it needs; its control mode does
            not fit its drive, or a sensor has the name of another frame.
        PluginError: environment, robot or a sensor cannot be built.
        MissingLibraryError: this machine cannot draw the requested colour images.
    """
    robots = tuple(request.scenario.robots)
    check_robots(request.choice, robots)
    builts = build_runs(request.scenario, request.registry, request.choice, request.options.record)
    cameras = (info.camera for built in builts.values() for info in built.infos.values())
    if any(camera is not None and camera.colour for camera in cameras):
        from crowdbot.core.sim.cameras.rendering import check_egl

        check_egl()
    return builts
