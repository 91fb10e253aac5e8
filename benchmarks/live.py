"""Lockstep steps a second over loopback, without a simulation behind them.

    .venv/bin/python benchmarks/live.py [STEPS]

A planner of a live run publishes a scan of 720 beams, odometry, tf and the clock in each step, and
waits for the command of a client in another process, which reads all of them and answers the clock.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from typing import Any

import cbor2
import numpy as np
from websockets.sync.client import connect

from crowdbot.core.live.message import Offer
from crowdbot.core.live.observed import Observed
from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import HolonomicDrive, RobotLimits, RobotModel
from crowdbot.core.types.sensor import Reading, SensorInfo

_TOPICS = ("/scan", "/odom", "/tf", "/clock")
_FORMS = ("none", "cbor", "cbor-raw")
LIDAR = SensorInfo(
    category="lidar", frame="front", mount=(0.0, 0.0, 0.3, 0.0), rate=20.0, shape=(720,),
    ros_type="sensor_msgs/msg/LaserScan", angles=np.linspace(-3.1, 3.1, 720), range_max=25.0,
)  # fmt: skip


def _model() -> RobotModel:
    limits = RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)
    return RobotModel(
        description="", base="base_link", base_height=0.0, limits=limits, footprint_radius=0.2,
        drive=HolonomicDrive(max_force=1.0, max_torque=1.0), height=1.0, force_height=0.5, mass=6.0,
    )  # fmt: skip


def client(port: int, form: str) -> None:
    """Answer each clock; in a process of its own."""
    twist = json.dumps({"op": "publish", "topic": "/cmd_vel", "msg": {"linear": {"x": 0.5}}})
    with connect(f"ws://127.0.0.1:{port}", compression=None, max_size=None) as socket:
        for topic in _TOPICS:
            wish = {"op": "subscribe", "topic": topic, "compression": form}
            socket.send(json.dumps(wish))
        socket.send(json.dumps({"op": "advertise", "topic": "/cmd_vel"}))
        for frame in socket:
            message: Any
            message = cbor2.loads(frame) if isinstance(frame, bytes) else json.loads(frame)
            if message["topic"] == "/clock":
                socket.send(twist)


def measure(form: str, steps: int) -> list[float]:
    """Seconds of each step."""
    session = LiveSession()
    server = RosbridgeServer(session, Address(port=0), services(session))
    observed = Observed({"front": LIDAR}, _model())
    server.open([Offer(o.topic, o.msgtype) for o in observed.offers()])
    argv = [sys.executable, __file__, "client", str(server.port), form]
    rng, times = np.random.default_rng(0), []
    with subprocess.Popen(argv) as other:
        session.wait_for_driver(60.0)
        while not all(server.wants(t) for t in _TOPICS):
            time.sleep(0.01)
        for k in range(steps):
            t = 0.05 * k
            obs = Observation(
                t=t, pose=Pose(t, 0.0, 0.0), twist=(1.0, 0.0), goal=(9.0, 0.0),
                goal_zone=np.zeros((0, 2)),
                readings={"front": Reading(t, rng.uniform(0.1, 25.0, 720))},
            )  # fmt: skip
            begin = time.perf_counter()
            session.ask(ros.nanoseconds(t))
            server.publish(list(observed.messages(obs, server.wants)))
            if session.answer(10.0, lambda: None) is None:
                raise SystemExit(f"no answer to step {k}")
            times.append(time.perf_counter() - begin)
        server.close()
        other.wait()
    return times


def main(steps: int) -> None:
    """Print a line for each form."""
    sys.setswitchinterval(0.0005)
    for form in _FORMS:
        times = sorted(measure(form, steps)[10:])
        rate, worst = len(times) / sum(times), times[int(0.99 * len(times))]
        middle = 1e3 * statistics.median(times)
        print(f"{form:9} {rate:6.0f} steps/s, median {middle:.2f} ms, 99 % {1e3 * worst:.2f} ms")


if __name__ == "__main__":
    if sys.argv[1:2] == ["client"]:
        client(int(sys.argv[2]), sys.argv[3])
    else:
        main(int(sys.argv[1]) if sys.argv[1:] else 2000)
