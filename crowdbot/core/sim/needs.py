"""What a run needs from the robot and from the machine."""

from __future__ import annotations

from crowdbot.core.planner_source import select_sensors
from crowdbot.core.sim.request import Request


def check_needs(request: Request) -> None:
    """Refuse what this robot, or this machine, cannot give before anything is written.

    Raises:
        InputError: the robot lacks a sensor that the planner needs.
        MissingLibraryError: colour images are wanted where they cannot be drawn.
    """
    (robot,) = request.scenario.robots.values()
    infos = {n: request.registry.build(x).info() for n, x in robot.sensors.items()}
    choice = request.choice
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    cameras = [infos[n].camera for n in (infos if request.record == "all" else visible)]
    if any(camera is not None and camera.colour for camera in cameras):
        from crowdbot.core.sim.rendering import check_egl

        check_egl()
