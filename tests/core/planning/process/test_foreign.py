"""Planners of another Python, without anything that crowdbot has, and of another language."""

from __future__ import annotations

import contextlib
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.planner import named_drawing
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.errors import CrowdbotError, InputError, PlannerError
from tests.core.planning.process.process_cases import (
    FRONT,
    REGISTRY,
    hosted,
    observation,
)

EXAMPLES = Path(__file__).parents[4] / "docs" / "examples" / "planners"
#: Without site-packages, the user's folders and variables: the standard library alone.
BARE = f'#!/bin/sh\nexec {sys.executable} -S -I "$@"\n'
FILE = """
import math
from crowdbot_planner import Command, NoValidCommand

class Mine:
    needs = ("lidar",)
    role = "floor"
    def __init__(self, speed=0.25, path=()):
        self.speed = speed
    def reset(self, task, limits, sensors, seed):
        self.task, self.limits, self.sensors, self.seed = task, limits, sensors, seed
    def step(self, obs):
        if obs.t > 2.0:
            raise NoValidCommand
        if obs.t > 1.0:
            raise ValueError("lost")
        obs.log("mine/nearest", min(obs.readings["front"].values))
        obs.draw("why", lambda: [(1.0, 0.0)], text="waits")
        assert self.seed == 7 and self.task.start.x == 2.5 and self.limits.v_max == 0.65
        front = self.sensors["front"]
        assert len(front.angles) == 480 and front.camera is None and front.mount[0] == 0.2
        assert self.task.goal_zone[2][1] == 5.0
        return Command(self.speed, obs.pose.yaw - 3.0)
"""


def bare_python(folder: Path) -> Path:
    program = folder / "bare_python"
    program.write_text(BARE)
    program.chmod(0o755)
    return program


def document(folder: Path, text: str) -> PlannerChoice:
    file = folder / "planner.yaml"
    file.write_text(text)
    return resolve_planner(str(file), REGISTRY)


@pytest.fixture
def bare(tmp_path: Path) -> Path:
    bare_python(tmp_path)
    (tmp_path / "mine.py").write_text(FILE)
    (tmp_path / "planner.yaml").write_text("python: ./bare_python\nplanner: mine.py:Mine\n")
    return tmp_path / "planner.yaml"


def test_a_python_with_nothing_but_its_library(bare: Path) -> None:
    choice = resolve_planner(str(bare), REGISTRY, ["speed=0.5"])
    assert choice.needs == ("lidar",)
    assert choice.role == "candidate"  # it has parameters
    assert choice.spec_dump["kind"] == "planner.yaml:Mine"
    assert choice.spec_dump["runtime"].startswith("CPython 3.")
    assert choice.spec_dump["parameters"] == {"speed": 0.5}
    assert not choice.in_process
    signals: list[tuple[str, float]] = []
    drawings: list[tuple[Any, ...]] = []
    seen = observation(front=np.linspace(0.5, 3.0, 480))
    with hosted(choice, front=FRONT) as host:
        object.__setattr__(seen, "log", lambda name, value: signals.append((name, value)))
        object.__setattr__(seen, "draw", lambda *drawn: drawings.append(drawn))
        assert host.step(seen).command == (0.5, 0.0, 0.0)
        assert signals == [("mine/nearest", 0.5)]
        assert drawings == [("why", [[1.0, 0.0]], "waits")]
        assert host.step(observation(2.5, front=np.ones(480))).command == (0.0, 0.0, 0.0)
        assert host.stops == 1
        with pytest.raises(PlannerError, match=r"step: ValueError: lost \(.*mine\.py:16\)"):
            host.step(observation(1.5, front=np.ones(480)))


def test_a_text_that_is_too_long_ends_the_planner(bare: Path) -> None:
    file = bare.with_name("mine.py")
    file.write_text(file.read_text().replace('"waits"', '["x" * 81]'))
    seen = observation(front=np.ones(480))
    object.__setattr__(seen, "draw", named_drawing)
    with (
        hosted(resolve_planner(str(bare), REGISTRY), front=FRONT) as host,
        pytest.raises(PlannerError, match="a text of 'why' has at most 80 characters, not 81"),
    ):
        host.step(seen)


def test_arrays_and_images_in_both_kinds_of_python(tmp_path: Path) -> None:
    """What a planner sees is the same, whatever Python it is in."""
    from crowdbot.plugin import Observation, Pinhole, Reading, SensorInfo

    (tmp_path / "mine.py").write_text(
        "class Mine:\n"
        "    def reset(self, task, limits, sensors, seed): self.info = sensors['eye']\n"
        "    def step(self, obs):\n"
        "        eye = obs.readings['eye']\n"
        "        assert self.info.camera.width == 64 and tuple(self.info.shape) == (48, 64)\n"
        "        assert len(eye.values) == 48 and len(eye.colour[0]) == 64\n"
        "        return (float(eye.values[47][63]), float(eye.colour[1][2][0]) / 100.0)\n"
    )
    bare_python(tmp_path)
    (tmp_path / "bare.yaml").write_text("python: ./bare_python\nplanner: mine.py:Mine\n")
    (tmp_path / "full.yaml").write_text(f"python: {sys.executable}\nplanner: mine.py:Mine\n")
    eye = SensorInfo(
        category="camera", frame="eye", mount=(0.0, 0.0, 0.3, 0.0), rate=8.0, shape=(48, 64),
        ros_type="sensor_msgs/msg/Image",
        camera=Pinhole(width=64, height=48, focal=60.0, colour=True),
    )  # fmt: skip
    depth: Any = np.full((48, 64), 0.125, np.float32)
    colour = np.full((48, 64, 3), 25, np.uint8)
    plain = observation()
    seen = Observation(
        t=0.0, pose=plain.pose, twist=plain.twist, goal=plain.goal, goal_zone=plain.goal_zone,
        readings={"eye": Reading(0.0, depth, colour)},
    )  # fmt: skip
    answers = []
    for text in (tmp_path / "bare.yaml", tmp_path / "full.yaml", f"{tmp_path}/mine.py:Mine"):
        with hosted(resolve_planner(str(text), REGISTRY), eye=eye) as host:
            answers.append(host.step(seen).command)
    assert answers == [(0.125, 0.25, 0.0)] * 3


WRONG = {
    "no planner": ("python: ./bare_python", "'planner' is FILE.py:CLASS"),
    "no class": ("python: ./bare_python\nplanner: mine.py", "write FILE.py:CLASS"),
    "no file": ("python: ./bare_python\nplanner: no.py:Mine", "no such file"),
    "no python": ("python: ./nothing\nplanner: mine.py:Mine", "no program './nothing'"),
    "no program": ("command: [no-such-program-at-all]", "no program 'no-such-program-at-all'"),
    "no list": ("command: run", "is a list of words"),
    "empty": ("command: []", "is a list of words"),
    "both": ("command: [x]\npython: y\nplanner: a.py:B", "give 'command', or 'python'"),
    "misspelt": ("command: [ls]\nparametrs: {}", "did you mean 'parameters'"),
    "parameters": ("command: [ls]\nparameters: [1]", "is a mapping"),
    "name": ("command: [ls]\nname: ../up", "cannot be a planner's name"),
    "files": ("command: [ls]\nfiles: [weights-*.npz]", "nothing in"),
    "absolute files": ("command: [ls]\nfiles: [/etc/passwd]", "is not a name or pattern in"),
    "no files": ("command: [ls]\nfiles: ['']", "is not a name or pattern in"),
    "files above": ("command: [ls]\nfiles: ['../*']", "is not a name or pattern in"),
    "a date": ("command: [ls]\nparameters: {day: !!timestamp 2026-11-23}", ":2:19: error[E005]"),
    "bytes": ("command: [ls]\nparameters: {d: !!binary aGFsbA==}", ":2:17: error[E005]"),
    "aliases": ("command: [ls]\nparameters: {a: &a [1], b: *a}", ":2:17: error[E004]"),
    "unknown": ("python: ./bare_python\nplanner: mine.py:Mine\nparameters: {sped: 1}", "sped"),
    "other class": ("python: ./bare_python\nplanner: mine.py:Your", "no class 'Your'"),
    "speaks not": ("command: ['true']", "did not load: its process ended with exit code 0"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_document_that_is_wrong(case: str, bare: Path) -> None:
    text, reason = WRONG[case]
    bare.write_text(text)
    with pytest.raises(CrowdbotError) as caught:
        resolve_planner(str(bare), REGISTRY).build()
    assert reason in str(caught.value)
    assert "planner.yaml" in str(caught.value)


def test_a_program_cannot_run_in_our_process(bare: Path) -> None:
    with pytest.raises(InputError, match="cannot run in the simulator's process"):
        resolve_planner(str(bare), REGISTRY, place=PlannerPlace(in_process=True))


def test_everything_that_is_named_is_part_of_the_digest(bare: Path) -> None:
    def digest() -> str:
        return str(resolve_planner(str(bare), REGISTRY).spec_dump["sha256"])

    folder = bare.parent
    (folder / "weights.npz").write_bytes(b"1")
    bare.write_text("python: ./bare_python\nplanner: mine.py:Mine\nfiles: [weights.*]\n")
    first = digest()
    assert digest() == first
    (folder / "weights.npz").write_bytes(b"2")
    second = digest()
    (folder / "mine.py").write_text(FILE + "\n# changed\n")
    assert len({first, second, digest()}) == 3


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
def test_the_example_in_c_is_goal_seek(tmp_path: Path) -> None:
    from crowdbot.core.planning.host import PlannerHost
    from tests.core.planning.process.process_cases import LIMITS, TASK

    for file in EXAMPLES.iterdir():
        shutil.copy(file, tmp_path)
    subprocess.run(
        ["cc", "-O2", "-Wall", "-Werror", "-o", "goal_seek", "goal_seek.c", "-lm"],
        cwd=tmp_path, check=True,
    )  # fmt: skip
    choice = resolve_planner(str(tmp_path / "goal_seek.yaml"), REGISTRY)
    assert choice.name == "goal_seek_c"
    ours = PlannerHost(resolve_planner("goal_seek", REGISTRY).build(), "goal_seek", LIMITS)
    ours.reset(TASK, {}, 7)
    rng = np.random.default_rng(3)
    with hosted(choice) as host:
        for _ in range(50):
            seen: Any = observation()
            pose = type(seen.pose)(*rng.uniform((0.0, -5.0, -3.0), (50.0, 5.0, 3.0)))
            object.__setattr__(seen, "pose", pose)
            assert host.step(seen).command == ours.step(seen).command


def test_small_msgpack_is_msgpack() -> None:
    import msgpack
    from hypothesis import given
    from hypothesis import strategies as st

    from crowdbot.core.planning.process import small_msgpack

    plain: Any = st.none() | st.booleans() | st.integers(-(2**63), 2**64 - 1)
    plain = plain | st.floats(allow_nan=False) | st.text() | st.binary()
    values = st.recursive(
        plain, lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=30
    )

    @given(values)
    def same(value: Any) -> None:
        assert msgpack.unpackb(small_msgpack.packb(value)) == value
        assert small_msgpack.unpackb(msgpack.packb(value)) == value

    @given(st.binary(max_size=60))
    def whatever_comes(raw: bytes) -> None:
        with contextlib.suppress(ValueError):
            small_msgpack.unpackb(raw)

    same()
    whatever_comes()
    with pytest.raises(OverflowError):
        small_msgpack.packb(10**400)
    with pytest.raises(TypeError, match="set cannot be sent"):
        small_msgpack.packb({1})
