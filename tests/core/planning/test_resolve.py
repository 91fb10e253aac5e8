"""Planners by kind, by YAML file and by Python class."""

import re
from dataclasses import replace
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
import pytest
from pydantic import Field

from crowdbot.core.planning.choice import ANYWHERE, PlannerPlace
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner, select_sensors
from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from crowdbot.errors import InputError, PlannerError, UnknownNameError
from crowdbot.plugin import Component, PlannerSpec, PositiveLength, SensorInfo


class TinySpec(PlannerSpec):
    needs: ClassVar[tuple[str, ...]] = ("lidar",)
    kind: Literal["tiny"] = "tiny"
    speed: float = Field(default=1.0, gt=0, description="Speed.")
    length: PositiveLength = Field(default=0.5, description="Length, m.")


class HungrySpec(PlannerSpec):
    kind: Literal["acme.hungry"] = "acme.hungry"
    must: int = Field(description="No default.")


class SeerSpec(PlannerSpec):
    privileged: ClassVar[bool] = True
    kind: Literal["seer"] = "seer"


class Built:
    """What the build function below makes; a real planner would move."""

    def __init__(self, spec: PlannerSpec) -> None:
        self.spec = spec

    def reset(self, *given: object) -> None: ...

    def step(self, *given: object) -> None: ...


def build(spec: PlannerSpec) -> Built:
    return Built(spec)


BUILD = f"{__name__}:build"


@pytest.fixture
def registry() -> Registry:
    tiny = Component(spec=TinySpec, build=BUILD, summary="")
    seer = Component(spec=SeerSpec, build=BUILD, summary="")
    hungry = Component(spec=HungrySpec, build=BUILD, summary="")
    return assemble(
        [
            Plugin(name="builtin", distribution="crowdbot", components=(tiny, seer)),
            Plugin(name="acme", distribution="acme/", pinned=False, components=(hungry,)),
        ]
    )


def spec_of(choice: PlannerChoice) -> PlannerSpec:
    made = choice.build()
    assert isinstance(made, Built)
    return made.spec


# ----------------------------------------------------------------------------- kinds
def test_kind_with_defaults(registry: Registry) -> None:
    choice = resolve_planner("tiny", registry)
    assert (choice.name, choice.label, choice.pinned) == ("tiny", "tiny", True)
    assert choice.needs == ("lidar",)
    assert choice.spec_dump == {"kind": "tiny", "speed": 1.0, "length": 0.5}
    assert spec_of(choice) == TinySpec()
    assert choice.build() is not choice.build()


def test_settings_change_the_label_and_nothing_else_does(registry: Registry) -> None:
    plain = resolve_planner("tiny", registry, ["speed=1.0"])
    half = resolve_planner("tiny", registry, ["speed=0.5"])
    units = resolve_planner("tiny", registry, ["length=50 cm", "speed=5e-1"])
    assert plain.label == "tiny"
    prefix, _, digits = half.label.partition("+")
    assert (prefix, len(digits), int(digits, 16) >= 0) == ("tiny", 4, True)
    assert units.label == half.label
    assert resolve_planner("tiny", registry, ["speed=0.6"]).label != half.label
    assert spec_of(half) == TinySpec(speed=0.5)


def test_a_kind_without_defaults(registry: Registry) -> None:
    choice = resolve_planner("acme.hungry", registry, ["must=3"])
    assert not choice.pinned
    assert choice.needs is None
    assert choice.label.startswith("acme.hungry+")
    with pytest.raises(InputError, match=r"planner 'acme.hungry': must: Field required"):
        resolve_planner("acme.hungry", registry)


def test_unknown_kind(registry: Registry) -> None:
    with pytest.raises(UnknownNameError, match=r"unknown planner 'tny'; did you mean 'tiny'\?"):
        resolve_planner("tny", registry)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["sped=1"], r"planner 'tiny' has no parameter 'sped'; did you mean 'speed'\?"),
        (["speed=-1"], "planner 'tiny': speed: Input should be greater than 0"),
        (["speed=fast"], "planner 'tiny': speed: Input should be a valid number"),
        (["speed"], "'speed' is not a setting; write key=value"),
        (["=1"], "'=1' is not a setting"),
        (["speed=[1"], r"--planner-set:1:\d+: error\[E002\]"),
        (["speed=&a 1"], r"--planner-set:1:7: error\[E004\]"),
        (["speed=" + "9" * 6000], r"--planner-set:1:7: error\[E008\]"),
        (["speed=" + "[" * 900 + "]" * 900], r"--planner-set:1:46: error\[E009\]"),
        (["length=3 s"], "length: '3 s' is not a quantity of length"),
        (
            ["speed=.nan"],
            r"--planner-set:1:7: error\[E008\] .nan is not allowed; numbers are finite",
        ),
        (["speed=-1", "sped=1"], "(?s)speed:.*'sped'"),
    ],
)
def test_wrong_settings(registry: Registry, settings: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        resolve_planner("tiny", registry, settings)


# ------------------------------------------------------------------------ YAML files
def test_yaml_file(registry: Registry, tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("kind: tiny\nspeed: 0.5\nlength: 20 cm\n")
    choice = resolve_planner(str(file), registry, ["length=0.3"])
    assert spec_of(choice) == TinySpec(speed=0.5, length=0.3)
    same = resolve_planner("tiny", registry, ["length=0.3", "speed=0.5"])
    assert (choice.name, choice.label, choice.spec_dump) == (
        same.name,
        same.label,
        same.spec_dump,
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed: 1\n", "'kind' is missing"),
        ("kind: 3\n", "'kind' is missing"),
        ("- kind: tiny\n", "a planner is a mapping"),
        ("", "a planner is a mapping"),
        ("3: tiny\n", "'kind' is missing"),
        ("kind: tny\n", "did you mean 'tiny'"),
        ("kind: tiny\nsped: 1\n", "no parameter 'sped'"),
        ("kind: [tiny\n", r"mine.yml:2:1: error\[E002\]"),
        ("kind: tiny\nkind: tiny\n", r"mine.yml:2:1: error\[E003\]"),
        ("kind: tiny\nspeed: &a 1\n", r"mine.yml:2:8: error\[E004\]"),
        ("kind: tiny\nspeed: !!binary aGk=\n", r"mine.yml:2:8: error\[E005\]"),
        ("kind: tiny\nspeed: " + "9" * 6000, r"mine.yml:2:8: error\[E008\]"),
        ("kind: tiny\nspeed: " + "[" * 900 + "]" * 900, r"mine.yml:2:40: error\[E009\]"),
        ("kind: tiny\n" + "#" * 1_000_001, r"mine.yml:1:1: error\[E001\] is larger than 1 MB"),
    ],
)
def test_wrong_yaml_files(registry: Registry, tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "mine.yml"
    file.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        resolve_planner(str(file), registry)
    assert "mine.yml" in str(caught.value)


def test_unreadable_yaml_files(registry: Registry, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none.yaml:1:1: error\[E001\] no such file"):
        resolve_planner(str(tmp_path / "none.yaml"), registry)
    (tmp_path / "bin.yaml").write_bytes(b"\xff\xfe\x00\xd8")
    with pytest.raises(InputError, match=r"bin.yaml:1:1: error\[E001\] is UTF-16"):
        resolve_planner(str(tmp_path / "bin.yaml"), registry)
    with pytest.raises(InputError, match=r"error\[E001\] is a folder"):
        resolve_planner(f"{tmp_path}/", registry)


# ---------------------------------------------------------------------- Python files
SOURCE = """
from crowdbot.plugin import Command
import helper_beside

class Mine:
    needs = ("front_lidar",)
    def __init__(self, speed=0.5, name="x"):
        if speed < 0:
            raise ValueError("too slow")  # here
        self.speed = speed
    def reset(self, task, limits, sensors, seed): pass
    def step(self, obs): return Command(self.speed * helper_beside.HALF, 0.0)

class Lame:
    def step(self, obs): return None

def function(): pass
"""


INSIDE = PlannerPlace(in_process=True)


@pytest.fixture
def source(tmp_path: Path) -> Path:
    (tmp_path / "helper_beside.py").write_text("HALF = 0.5\n")
    file = tmp_path / "json.py"  # a name that must not shadow the standard library's
    file.write_text(SOURCE)
    return file


def test_class_in_a_file(registry: Registry, source: Path) -> None:
    choice = resolve_planner(f"{source}:Mine", registry, place=INSIDE)
    assert (choice.name, choice.label, choice.pinned) == ("Mine", "Mine", False)
    assert choice.needs == ("front_lidar",)
    assert choice.spec_dump["kind"] == "json.py:Mine"
    assert len(choice.spec_dump["sha256"]) == 64
    assert choice.build().step(None).v == 0.25  # type: ignore[arg-type]
    import json

    assert "crowdbot" not in str(json.__file__)


def test_class_with_settings(registry: Registry, source: Path) -> None:
    choice = resolve_planner(f"{source}:Mine", registry, ["speed=0.8"], INSIDE)
    assert choice.label.startswith("Mine+")
    assert choice.spec_dump["parameters"] == {"speed": 0.8}
    assert choice.build().step(None).v == 0.4  # type: ignore[arg-type]


def test_an_edited_file_is_read_again(registry: Registry, source: Path) -> None:
    before = resolve_planner(f"{source}:Mine", registry, place=INSIDE)
    source.write_text(SOURCE.replace("speed=0.5", "speed=0.25  "))
    after = resolve_planner(f"{source}:Mine", registry, place=INSIDE)
    assert after.build().step(None).v == 0.125  # type: ignore[arg-type]
    assert before.spec_dump["sha256"] != after.spec_dump["sha256"]


def test_modules_beside_it_are_part_of_the_digest(registry: Registry, source: Path) -> None:
    def digest() -> object:
        return resolve_planner(f"{source}:Mine", registry).spec_dump["sha256"]

    before = digest()
    (source.parent / "stranger.py").write_text("X = 1\n")
    assert digest() == before
    (source.parent / "helper_beside.py").write_text(
        "HALF = 0.5\ndef late():\n    import stranger\n"
    )
    changed = digest()
    assert changed != before
    (source.parent / "stranger.py").write_text("X = 2\n")
    assert digest() != changed


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        ("Mime", [], r"no class 'Mime'; did you mean 'Mine'\?"),
        ("function", [], "no class 'function'"),
        ("", [], "no class ''"),
        ("Lame", [], "class 'Lame' is not a planner: no reset"),
        ("Command", [], "no reset and no step"),
        ("Mine", ["sped=1"], "unexpected keyword argument 'sped'; its parameters: speed, name"),
    ],
)
def test_wrong_classes(
    registry: Registry, source: Path, name: str, settings: list[str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        resolve_planner(f"{source}:{name}", registry, settings)


def test_missing_python_files(registry: Registry, source: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none.py: no such file"):
        resolve_planner(str(tmp_path / "none.py:Mine"), registry)
    with pytest.raises(InputError, match=r"no such file; did you mean .*json.py:Mine\?"):
        resolve_planner(f"{source.with_suffix('')}:Mine", registry)
    with pytest.raises(InputError, match=r"which class\? Write .*json.py:Mine"):
        resolve_planner(str(source), registry)
    with pytest.raises(InputError, match=r"which class\? Write .*none.py:Class"):
        resolve_planner(str(tmp_path / "none.py"), registry)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\nimport no_such_module_x\n", r"ModuleNotFoundError: .*bad.py:2\)"),
        ("x = (\n", "SyntaxError: '\\(' was never closed"),
        ("raise SystemExit(3)\n", r"SystemExit: 3 \(.*bad.py:1\)"),
    ],
)
def test_python_files_that_cannot_be_imported(
    registry: Registry, tmp_path: Path, text: str, message: str
) -> None:
    (tmp_path / "bad.py").write_text(text)
    with pytest.raises(PlannerError, match=message):
        resolve_planner(str(tmp_path / "bad.py:Mine"), registry)


MEAN = """class Mean(type):
    @property
    def {asked}(cls):
        raise SystemExit(3)
class Mine(metaclass=Mean):
    def reset(self, *a): ...
    def step(self, obs): ...
"""


@pytest.mark.parametrize(
    ("place", "asked", "doing"),
    [
        (ANYWHERE, "needs", "what it says of itself"),
        (INSIDE, "needs", "what it says of itself"),
        (INSIDE, "role", "what it says of itself"),
        (INSIDE, "data", "what it says of itself"),
        (INSIDE, "reset", "cannot be loaded"),
        (INSIDE, "__signature__", "its parameters"),
    ],
)
def test_classes_that_raise_when_they_are_asked(
    registry: Registry, tmp_path: Path, place: PlannerPlace, asked: str, doing: str
) -> None:
    (tmp_path / "bad.py").write_text(MEAN.format(asked=asked))
    with pytest.raises(PlannerError, match=rf"Mine.*: {doing}: SystemExit: 3 \(.*bad.py:4\)"):
        resolve_planner(f"{tmp_path}/bad.py:Mine", registry, place=place)


def test_a_file_that_raises_when_it_is_asked(registry: Registry, tmp_path: Path) -> None:
    (tmp_path / "bad.py").write_text("def __getattr__(name):\n    raise SystemExit(name)\n")
    with pytest.raises(PlannerError, match=r"'Mine'.*SystemExit: Mine \(.*bad.py:2\)"):
        resolve_planner(f"{tmp_path}/bad.py:Mine", registry, place=INSIDE)


def test_a_class_that_cannot_be_made(registry: Registry, source: Path) -> None:
    choice = resolve_planner(f"{source}:Mine", registry, ["speed=-1"], INSIDE)
    with pytest.raises(
        PlannerError, match=r"'Mine' .*: cannot be built: ValueError: too slow .*py:\d+"
    ):
        choice.build()


def test_nothing_of_a_planner_in_its_own_process_is_imported_here(
    registry: Registry, tmp_path: Path
) -> None:
    import sys

    (tmp_path / "told.py").write_text(
        "class Told:\n"
        "    needs, role, privileged = ('front',), 'floor', True\n"
        "    def reset(self, *a): ...\n"
        "    def step(self, obs): ...\n"
    )
    before = set(sys.modules)
    choice = resolve_planner(f"{tmp_path}/told.py:Told", registry)
    assert (choice.needs, choice.role, choice.privileged) == (("front",), "floor", True)
    assert (choice.in_process, choice.process, choice.memory) == (False, "own", 4 << 30)
    assert not any("crowdbot_planner_" in name for name in set(sys.modules) - before)


def test_our_own_run_inside_unless_they_are_told_otherwise() -> None:
    ours = discover(allow=())
    assert resolve_planner("dwa", ours).process == "in_process"
    assert resolve_planner("dwa", ours, place=PlannerPlace(in_process=False)).process == "own"


def test_a_registry_that_no_other_process_can_make(registry: Registry) -> None:
    assert resolve_planner("tiny", registry).in_process
    with pytest.raises(InputError, match="known to this process only"):
        resolve_planner("tiny", registry, place=PlannerPlace(in_process=False))


# --------------------------------------------------------------------------- sensors
def info(category: str) -> SensorInfo:
    return SensorInfo(
        category=category,
        frame="x",
        mount=(0, 0, 0, 0),
        rate=16.0,
        shape=(1,),
        ros_type="x",
        angles=np.zeros(1),
    )


SENSORS = {"front": info("lidar"), "odometry": info("odometry"), "rear": info("lidar")}


def test_needs_name_sensors_or_categories() -> None:
    assert select_sensors(None, SENSORS, "p") == ("front", "odometry", "rear")
    assert select_sensors((), SENSORS, "p") == ()
    assert select_sensors(("lidar",), SENSORS, "p") == ("front", "rear")
    assert select_sensors(("rear", "odometry"), SENSORS, "p") == ("odometry", "rear")


def test_a_need_that_the_robot_cannot_meet() -> None:
    with pytest.raises(
        InputError, match=r"planner 'p' needs 'sonar'; the robot's sensors: front, "
    ):
        select_sensors(("lidar", "sonar"), SENSORS, "p")
    with pytest.raises(InputError, match=r"sensors: none"):
        select_sensors(("lidar",), {}, "p")


TRUTH = {**SENSORS, "tracker": replace(SENSORS["front"], category="people", privileged=True)}


def test_privileged_sensors_are_for_privileged_planners() -> None:
    assert select_sensors(None, TRUTH, "p") == ("front", "odometry", "rear")
    assert select_sensors(None, TRUTH, "p", privileged=True) == tuple(TRUTH)
    for need in ("people", "tracker"):
        assert select_sensors((need,), TRUTH, "p", privileged=True) == ("tracker",)
        with pytest.raises(InputError, match=r"needs 'tracker', which is privileged"):
            select_sensors((need,), TRUTH, "p")


def test_the_label_says_that_a_planner_is_privileged(registry: Registry, tmp_path: Path) -> None:
    seer = resolve_planner("seer", registry)
    assert (seer.privileged, seer.label) == (True, "seer+privileged")
    file = tmp_path / "oracle.py"
    file.write_text(
        "class Oracle:\n"
        "    privileged = True\n"
        "    def __init__(self, gain=1.0): pass\n"
        "    def reset(self, task, limits, sensors, seed): pass\n"
        "    def step(self, obs): return 0.0, 0.0\n"
        "class Honest(Oracle):\n"
        "    privileged = False\n",
        encoding="utf-8",
    )
    oracle = resolve_planner(f"{file}:Oracle", registry)
    assert oracle.privileged
    assert oracle.label == "Oracle+privileged"
    other = resolve_planner(f"{file}:Oracle", registry, ["gain=2.0"])
    assert re.fullmatch(r"Oracle\+[0-9a-f]{4}\+privileged", other.label)
    honest = resolve_planner(f"{file}:Honest", registry)
    assert (honest.privileged, honest.label) == (False, "Honest")


def test_a_failing_planner_says_where_it_comes_from(tmp_path: Path) -> None:
    """Our own are treated like any other."""
    assert resolve_planner("dwa", discover(allow=())).origin.startswith("crowdbot ")
    file = tmp_path / "mine.py"
    file.write_text("class Mine:\n    def reset(self, *a): ...\n    def step(self, obs): ...\n")
    assert resolve_planner(f"{file}:Mine", discover(allow=())).origin == str(file)
