"""What ``import crowdbot`` offers, and what it costs."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import crowdbot

NAMES = [
    "Command",
    "Commands",
    "CrowdbotError",
    "LidarPoints",
    "NoValidCommand",
    "Observation",
    "PersonEstimate",
    "PersonTask",
    "Planner",
    "Pose",
    "Questionnaires",
    "Reading",
    "Recording",
    "RecordingWarning",
    "Results",
    "RobotLimits",
    "Run",
    "Scenario",
    "Score",
    "Scores",
    "SensorInfo",
    "Session",
    "Suite",
    "Task",
    "Trajectories",
    "Truth",
    "evaluate",
    "expand",
    "load",
    "results",
    "score",
    "simulate",
]


def test_all_is_what_was_promised() -> None:
    assert crowdbot.__all__ == NAMES
    assert dir(crowdbot) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_every_name_resolves(name: str) -> None:
    assert callable(getattr(crowdbot, name))


FUNCTIONS = [n for n in NAMES if n.islower()]
CONSTRUCTORS = [
    (
        crowdbot.Trajectories,
        (
            "from_arrays",
            "from_csv",
            "from_pandas",
            "from_rosbag",
            "from_trajnet",
            "from_eth_ucy",
            "from_mcap",
        ),
    ),
    (crowdbot.Commands, ("from_arrays", "from_csv")),
    (crowdbot.Questionnaires, ("from_mapping", "from_csv")),
    (crowdbot.Recording, ("__init__", "trajectories", "scans", "robot")),
    (crowdbot.Results, ("open", "to_pandas", "to_arrow")),
    (crowdbot.Run, ("open",)),
    (crowdbot.Scores, ("to_pandas", "to_arrow", "find")),
    (crowdbot.Session, ("reset", "step", "observe", "close")),
]


def _signatures() -> Iterator[tuple[str, inspect.Signature]]:
    for name in FUNCTIONS:
        yield name, inspect.signature(getattr(crowdbot, name))
    for cls, names in CONSTRUCTORS:
        for name in names:
            yield f"{cls.__name__}.{name}", inspect.signature(getattr(cls, name))


@pytest.mark.parametrize(("name", "signature"), list(_signatures()))
def test_every_option_has_a_name_and_a_type(name: str, signature: inspect.Signature) -> None:
    for parameter in signature.parameters.values():
        if parameter.name == "self":
            continue
        assert parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL), name
        assert parameter.annotation is not parameter.empty, (name, parameter.name)
        assert "Any" not in str(parameter.annotation), (name, parameter.name)
    assert "Any" not in str(signature.return_annotation), name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_option_is_documented(name: str) -> None:
    text = inspect.getdoc(getattr(crowdbot, name)) or ""
    for parameter in inspect.signature(getattr(crowdbot, name)).parameters:
        assert re.search(rf"\b{parameter}\b", text), (name, parameter)


def test_a_wrong_option_is_a_type_error() -> None:
    scenario = _scenario()
    with pytest.raises(TypeError, match="headless"):
        crowdbot.simulate(scenario, headless=True)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="robot_raduis"):
        crowdbot.Trajectories.from_csv("robot.csv", robot_raduis=0.2)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="positional"):
        crowdbot.simulate(scenario, "dwa")  # type: ignore[call-arg]


@pytest.mark.parametrize(("options", "message"), [
    ({"seed": -1}, "at least 0, not -1"),
    ({"record": "some"}, "record must be 'all' or 'used' or 'none', not 'some'"),
    ({"suite": "../elsewhere"}, "'../elsewhere' must be usable as the name of a folder"),
    ({"step_budget": 0.0}, "above 0 and below"),
    ({"metrics": "risks"}, "unknown metric 'risks'"),
    ({"planner": "dwaa"}, "unknown planner 'dwaa'"),
    ({"planner_settings": ["horizon"]}, "horizon"),
])  # fmt: skip
def test_a_wrong_value_is_our_error(options: dict[str, Any], message: str, tmp_path: Path) -> None:
    """It is told before anything is simulated."""
    with pytest.raises(crowdbot.CrowdbotError, match=re.escape(message)):
        crowdbot.simulate(_scenario(), out=tmp_path, **options)
    assert not list(tmp_path.iterdir())


def _scenario() -> crowdbot.Scenario:
    found = crowdbot.load("challenge-2020", "counter-d0250-dispersed-c20-r05")
    assert isinstance(found, crowdbot.Scenario)
    return found


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="simulato"):
        getattr(crowdbot, "simul" + "ato")


def _loaded_by(statement: str) -> set[str]:
    code = f"import sys\n{statement}\nprint(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {m.partition(".")[0] for m in done.stdout.split()}


def test_import_loads_nothing_heavy() -> None:
    loaded = _loaded_by("import crowdbot")
    assert "crowdbot" in loaded
    assert not loaded & {"numpy", "numba", "pydrake", "pydantic", "typer", "rich", "pluggy"}


@pytest.mark.slow
def test_loading_a_suite_needs_neither_numbers_nor_drake() -> None:
    loaded = _loaded_by("import crowdbot; assert crowdbot.load('challenge-2020').scenarios")
    assert "pydantic" in loaded
    assert not loaded & {"numpy", "numba", "pydrake"}


def test_trajectories_need_neither_drake_nor_scipy() -> None:
    loaded = _loaded_by("import crowdbot; crowdbot.Trajectories; crowdbot.score")
    assert not loaded & {"pydrake", "scipy"}


def test_simulating_needs_no_scipy() -> None:
    """It takes a third of a second to load; what a bag's frames or statistics need is lazy."""
    assert "scipy" not in _loaded_by("import crowdbot; crowdbot.simulate")
