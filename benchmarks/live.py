"""Lockstep steps a second over loopback, without a simulation behind them.

    .venv/bin/python benchmarks/live.py [STEPS]

A planner of a live run publishes a scan of 720 beams, odometry, tf and the clock in each step, and
waits for the command of a client in another process, which reads all of them and answers the clock.

Besides the rate it prints what a step costs: processor time of both processes (ms), which is what
a step takes on an idle machine, and the time in which their threads could have run but had no
processor (ms; Linux only), which is what others on this machine add.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import cbor2
import numpy as np
from websockets.sync.client import connect

from crowdbot.core.live.message import OfferedTopic
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
#: Steps that are not counted.
_FIRST = 10
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


class Spent(NamedTuple):
    """Of one process since it began, s."""

    processor: float
    waiting: float


def spent() -> Spent:
    """What this process used, and how long its threads waited for a processor."""
    waited = 0
    for file in Path("/proc/self/task").glob("*/schedstat"):
        waited += int(file.read_text().split()[1])
    return Spent(time.process_time(), waited / 1e9)


def client(port: int, form: str, steps: int) -> None:
    """Answer each clock; in a process of its own. Prints what it spent on the steps."""
    begin, heard = spent(), 0
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
                heard += 1
                begin = spent() if heard == _FIRST else begin
                if heard == steps:  # while all threads are there
                    end = spent()
                    print(end.processor - begin.processor, end.waiting - begin.waiting, flush=True)
                socket.send(twist)


def measure(form: str, steps: int) -> tuple[list[float], Spent]:
    """Seconds of each step, and what both processes spent on one."""
    session = LiveSession()
    server = RosbridgeServer(session, Address(port=0), services(session))
    observed = Observed({"front": LIDAR}, _model())
    server.open([OfferedTopic(o.topic, o.msgtype) for o in observed.offers()])
    argv = [sys.executable, __file__, "client", str(server.port), form, str(steps)]
    scans, times = np.random.default_rng(0).uniform(0.1, 25.0, (steps, 720)), []
    with subprocess.Popen(argv, stdout=subprocess.PIPE, text=True) as other:
        session.wait_for_driver(60.0)
        while not all(server.wants(t) for t in _TOPICS):
            time.sleep(0.01)
        before = spent()
        for k in range(steps):
            before = spent() if k == _FIRST else before
            t = 0.05 * k
            obs = Observation(
                t=t, pose=Pose(t, 0.0, 0.0), twist=(1.0, 0.0), goal=(9.0, 0.0),
                goal_zone=np.zeros((0, 2)),
                readings={"front": Reading(t, scans[k])},
            )  # fmt: skip
            begin = time.perf_counter()
            session.ask(ros.nanoseconds(t))
            server.publish(list(observed.messages(obs, server.wants)))
            if session.answer(10.0, lambda: None) is None:
                raise SystemExit(f"no answer to step {k}")
            times.append(time.perf_counter() - begin)
        after = spent()
        server.close()
        assert other.stdout is not None
        theirs = Spent(*map(float, other.stdout.readline().split()))
    ours = Spent(*(a - b for a, b in zip(after, before, strict=True)))
    both = (a + b for a, b in zip(ours, theirs, strict=True))
    return times[_FIRST:], Spent(*(x / (steps - _FIRST) for x in both))


def main(steps: int) -> None:
    """Print a line for each form."""
    sys.setswitchinterval(0.0005)
    for form in _FORMS:
        times, each = measure(form, steps)
        rate, worst = len(times) / sum(times), sorted(times)[int(0.99 * len(times))]
        middle = 1e3 * statistics.median(times)
        print(
            f"{form:9} {rate:6.0f} steps/s, median {middle:.2f} ms, 99 % {1e3 * worst:.2f} ms; "
            f"of a step {1e3 * each.processor:.2f} ms processor, {1e3 * each.waiting:.2f} ms "
            f"waiting for one: {1.0 / each.processor:.0f} steps/s without waiting"
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["client"]:
        client(int(sys.argv[2]), sys.argv[3], int(sys.argv[4]))
    else:
        main(int(sys.argv[1]) if sys.argv[1:] else 2000)
