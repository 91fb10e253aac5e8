"""A client of its own process: drives to the goal in lockstep through roslibpy.

    python roslibpy_driver.py PORT Twist|TwistStamped

It hears /crowdbot/task and /crowdbot/observation, and commands what `Pursuit` of `pursuit.py`
would. It ends when the run does.
"""

from __future__ import annotations

import sys
import threading
from typing import Any

import roslibpy  # type: ignore[import-untyped]

from crowdbot.core.types.ending import Ending
from tests.core.live.pursuit import follow

_ENDED = {ending.value for ending in Ending if ending.complete}


def main(port: int, kind: str) -> int:
    ros = roslibpy.Ros("127.0.0.1", port)
    ros.run(timeout=30)
    done = threading.Event()
    goal: list[float] = []
    command = roslibpy.Topic(ros, "/cmd_vel", f"geometry_msgs/{kind}")

    def on_task(message: dict[str, Any]) -> None:
        goal[:] = message["goal"]

    def on_observation(message: dict[str, Any]) -> None:
        v, w = follow(message["pose"], goal)
        twist = {"linear": {"x": v, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": w}}
        stamped = {"header": message["header"], "twist": twist}
        command.publish(roslibpy.Message(stamped if kind == "TwistStamped" else twist))

    def on_status(message: dict[str, Any]) -> None:
        if message["state"] in _ENDED:
            done.set()

    roslibpy.Topic(ros, "/crowdbot/task", "crowdbot_msgs/Task").subscribe(on_task)
    observed = roslibpy.Topic(ros, "/crowdbot/observation", "crowdbot_msgs/Observation")
    observed.subscribe(on_observation)
    status = roslibpy.Topic(ros, "/crowdbot/status", "crowdbot_msgs/LiveStatus")
    status.subscribe(on_status)
    command.advertise()
    ended = done.wait(600.0)
    ros.terminate()
    return 0 if ended else 1


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), sys.argv[2]))
