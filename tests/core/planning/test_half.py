"""A planner within a planner's document: kinds, programs, files; what each of both sees."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np
import pytest
from pydantic import Field

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.half import PlannerWithHalf
from crowdbot.core.planning.planner import Truth
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from crowdbot.errors import InputError, PlannerError, UnknownNameError
from crowdbot.plugin import (
    Command,
    Component,
    Observation,
    Planner,
    PlannerDocument,
    PlannerSpec,
    Pose,
    Reading,
    RobotLimits,
    SensorInfo,
    Task,
)

LIMITS = RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)
TASK = Task(start=Pose(0, 0, 0), goal=(1, 0), goal_zone=np.zeros((4, 2)), time_limit=1.0)


class SeeingSpec(PlannerSpec):
    needs: ClassVar[tuple[str, ...]] = ("lidar",)
    kind: Literal["seeing"] = "seeing"
    speed: float = Field(default=5.0, description="Speed, far beyond the limits.")


class SeerSpec(PlannerSpec):
    privileged: ClassVar[bool] = True
    kind: Literal["seer"] = "seer"


class WrapSpec(PlannerSpec):
    needs: ClassVar[tuple[str, ...]] = ("joystick",)
    half: ClassVar[str] = "autonomy"
    kind: Literal["wrap"] = "wrap"
    autonomy: PlannerDocument | None = Field(default={"kind": "seeing"}, description="Half.")


class AcmeWrapSpec(WrapSpec):
    kind: Literal["acme.wrap"] = "acme.wrap"  # type: ignore[assignment]


class Seeing:
    def __init__(self, spec: Any) -> None:
        self.spec, self.seen = spec, list[Any]()

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        del task, limits
        self.seen = [tuple(sensors), seed]

    def step(self, obs: Observation) -> Command:
        self.seen += [tuple(obs.readings), obs.truth]
        return Command(getattr(self.spec, "speed", 0.0), 0.0)


class Wrap:
    def __init__(self, spec: WrapSpec, half: Planner | None = None) -> None:
        self.spec, self.half = spec, half

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        if self.half is not None:
            self.half.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        return Command(0.0, 0.5) if self.half is None else self.half.step(obs)


def component(spec: type[PlannerSpec], build: type) -> Component[Any]:
    return Component(spec=spec, build=f"{__name__}:{build.__name__}", summary="")


@pytest.fixture
def registry() -> Registry:
    ours = (component(SeeingSpec, Seeing), component(SeerSpec, Seeing), component(WrapSpec, Wrap))
    acme = (component(AcmeWrapSpec, Wrap),)
    return assemble(
        [
            Plugin(name="builtin", distribution="crowdbot", components=ours),
            Plugin(name="acme", distribution="acme/", pinned=False, components=acme),
        ]
    )


def info(category: str) -> SensorInfo:
    return SensorInfo(category=category, frame="x", mount=(0, 0, 0, 0), rate=16.0, shape=(2,),
                      ros_type="x", angles=np.zeros(2))  # fmt: skip


SENSORS = {"stick": info("joystick"), "front": info("lidar")}
TRUTH = Truth(pose=Pose(0, 0, 0), velocity=(0, 0, 0), people=np.zeros((0, 2)),
              people_velocity=np.zeros((0, 2)), people_radius=np.zeros(0),
              people_id=np.zeros(0, np.int64))  # fmt: skip


def observation() -> Observation:
    readings = {n: Reading(0.0, np.zeros(2)) for n in SENSORS}
    return Observation(t=0.0, pose=Pose(0, 0, 0), twist=(0, 0), goal=(1, 0), truth=TRUTH,
                       goal_zone=np.zeros((4, 2)), readings=readings)  # fmt: skip


def test_a_half_sees_its_own_sensors_and_no_truth_and_keeps_the_limits(registry: Registry) -> None:
    choice = resolve_planner("wrap", registry)
    assert (choice.label, choice.needs, choice.privileged) == ("wrap", ("joystick", "lidar"), False)
    made = choice.build()
    assert isinstance(made, PlannerWithHalf)
    made.reset(TASK, LIMITS, SENSORS, 7)
    assert made.step(observation()) == Command(1.0, 0.0)
    inner = made.half._planner
    assert isinstance(inner, Seeing)
    assert inner.seen == [("front",), 7, ("front",), None]


def test_a_half_with_other_parameters_is_another_planner(registry: Registry) -> None:
    plain = resolve_planner("wrap", registry, ["autonomy=seeing"])
    slow = resolve_planner("wrap", registry, ["autonomy={kind: seeing, speed: 0.5}"])
    assert plain.label == "wrap"
    assert slow.label.startswith("wrap+")
    assert slow.spec_dump["autonomy"] == {"kind": "seeing", "speed": 0.5}
    nested = resolve_planner("wrap", registry, ["autonomy={kind: wrap, autonomy: seeing}"])
    assert nested.spec_dump["autonomy"]["autonomy"] == {"kind": "seeing", "speed": 5.0}
    nested.build().reset(TASK, LIMITS, SENSORS, 0)


def test_a_privileged_half_makes_the_whole_privileged(registry: Registry) -> None:
    choice = resolve_planner("wrap", registry, ["autonomy=seer"])
    assert (choice.privileged, choice.needs) == (True, None)
    assert choice.label.endswith("+privileged")
    made = choice.build()
    assert isinstance(made, PlannerWithHalf)
    made.reset(TASK, LIMITS, SENSORS, 0)
    made.step(observation())
    inner = made.half._planner
    assert isinstance(inner, Seeing)
    assert inner.seen[2] == ("stick", "front")
    assert inner.seen[3] is not None


def test_a_planner_may_do_without_its_half(registry: Registry) -> None:
    choice = resolve_planner("wrap", registry, ["autonomy=null"])
    assert choice.needs == ("joystick",)
    assert choice.build().step(observation()) == Command(0.0, 0.5)


@pytest.mark.parametrize(
    ("document", "error", "words"),
    [
        ("{kind: wrap, autonomy: {kind: seeinng}}", UnknownNameError,
         r"p.yaml: autonomy: planner 'seeinng'.*seeing"),
        ("{kind: wrap, autonomy: {kind: seeing, sped: 1.0}}", InputError,
         r"p.yaml: autonomy: planner 'seeing' has no parameter 'sped'; did you mean 'speed'"),
        ("{kind: wrap, autonomy: {speed: 1.0}}", InputError,
         r"p.yaml: autonomy: 'kind' is missing"),
        ("{kind: wrap, autonomy: 3}", InputError, r"p.yaml: planner 'wrap': autonomy"),
        ("{kind: acme.wrap, autonomy: 'mine.py:Mine'}", InputError,
         r"p.yaml: autonomy: 'acme.wrap' runs in a process of its own; name a kind"),
    ],
)  # fmt: skip
def test_a_wrong_half_is_named(
    registry: Registry, tmp_path: Path, document: str, error: type[Exception], words: str
) -> None:
    (tmp_path / "p.yaml").write_text(document)
    with pytest.raises(error, match=words):
        resolve_planner(str(tmp_path / "p.yaml"), registry)


def test_a_half_may_be_a_file_beside_the_document_and_has_its_own_process(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "class Mine:\n"
        "    needs = ('lidar',)\n"
        "    def reset(self, task, limits, sensors, seed): self.names = sorted(sensors)\n"
        "    def step(self, obs): return 0.25, 0.1 * len(self.names)\n"
    )
    (tmp_path / "p.yaml").write_text(
        "{kind: linear_blending, arbitration: fixed, share: 1.0, autonomy: 'mine.py:Mine'}"
    )
    choice = resolve_planner(str(tmp_path / "p.yaml"), discover(allow=()))
    assert (choice.process, choice.pinned) == ("own", False)
    assert choice.spec_dump["autonomy"]["kind"] == "mine.py:Mine"
    made = choice.build()
    assert isinstance(made, PlannerWithHalf)
    try:
        made.reset(TASK, LIMITS, SENSORS, 0)
        assert made.step(observation()) == Command(0.25, 0.1)
    finally:
        made.close()


def test_a_half_that_fails_is_the_reason(tmp_path: Path) -> None:
    (tmp_path / "bad.py").write_text(
        "class Bad:\n"
        "    def reset(self, task, limits, sensors, seed): ...\n"
        "    def step(self, obs): raise ValueError('no idea')\n"
    )
    ours = discover(allow=())
    settings = [f"autonomy={tmp_path}/bad.py:Bad"]
    made = resolve_planner("linear_blending", ours, settings, PlannerPlace(in_process=True)).build()
    made.reset(TASK, LIMITS, SENSORS, 0)
    with pytest.raises(PlannerError, match=r"planner 'Bad' .*no idea"):
        made.step(observation())
