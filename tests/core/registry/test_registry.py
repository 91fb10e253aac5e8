"""Plugins are found, isolated from each other, and never win by being first or last."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.component_list import ComponentList, ComponentsByKind
from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from crowdbot.core.support.source_digest import declared_data
from crowdbot.errors import PluginError, UnknownNameError
from crowdbot.plugin import Component

PLUGIN = """
from typing import ClassVar, Literal
from crowdbot.plugin import Component
from crowdbot.plugin import PlannerSpec, RobotSpec
from crowdbot.plugin import hookimpl
CROWDBOT_API = {api}

class Spec({base}):
    kind: Literal["{kind}"] = "{kind}"
    gain: float = 1.0

@hookimpl
def {hook}():
    return {{"{category}": [Component(spec=Spec, build="{name}:build", summary="test")]}}

def build(spec):
    return spec
"""


@pytest.fixture(autouse=True)
def _forget() -> Iterator[None]:
    """Plugins given by hand stay imported under their own names."""
    yield
    for name in ("acme", "broken"):
        sys.modules.pop(name, None)


def plugin(folder: Path, name: str = "acme", **changes: Any) -> Path:
    given = {
        "api": 1,
        "kind": f"{name}.go",
        "hook": "crowdbot_components",
        "category": "planner",
        "name": name,
        "base": "PlannerSpec",
    }
    given |= changes
    path = folder / f"{name}.py"
    path.write_text(PLUGIN.format(**given), encoding="utf-8")
    return path


def found(*paths: Path) -> Registry:
    return discover(extra=paths, entry_points=False)


def error_of(registry: Registry, name: str) -> str:
    return " / ".join(p.error for p in registry.plugins if p.name == name)


def test_everything_built_in_is_there() -> None:
    registry = found()
    assert [p.error for p in registry.plugins] == [""]
    kinds = {c: set(registry.components(c)) for c in registry._by_category}
    assert kinds["environment"] >= {"corridor"}
    assert kinds["robot"] >= {"turtlebot2"}
    assert kinds["sensor"] >= {"lidar2d", "lidar3d", "ultrasound", "infrared", "wheel_odometry"}
    assert kinds["noise"] >= {"gaussian", "offset", "peak"}
    assert kinds["planner"] >= {"goal_seek", "stop_and_go", "dwa"}
    assert kinds["crowd policy"] >= {"velocity_space"}
    assert kinds["cost function"] >= {"ttca_dca", "rvo"}
    assert len(kinds["metric"]) >= 5
    for category, components in registry._by_category.items():
        for kind, component in components.items():
            assert (component.kind, component.category) == (kind, category)
            assert callable(load_build(component))
            assert component.summary


def test_equal_registries_have_one_model_of_scenarios(tmp_path: Path) -> None:
    assert found().scenario_model is found().scenario_model
    planner = found(plugin(tmp_path))
    assert planner.scenario_model is found().scenario_model  # no scenario holds a planner
    other = plugin(tmp_path, "broken", category="robot", base="RobotSpec")
    more = found(other)
    assert more.scenario_model is not found().scenario_model
    assert more.scenario_model is more.scenario_model


def test_a_category_is_asked_for_once_when_it_is_wanted() -> None:
    asked: list[str] = []

    def later(category: str) -> Callable[[], tuple[Component[Any], ...]]:
        def ask() -> tuple[Component[Any], ...]:
            asked.append(category)
            return tuple(registry.components(category).values())

        return ask

    registry = found()
    listed = ComponentList({c: later(c) for c in ("robot", "planner", "metric")})
    assert listed.known == ()
    by_kind = ComponentsByKind(("robot", "planner", "metric"), [listed])
    assert list(by_kind) == ["robot", "planner", "metric"]
    assert by_kind["robot"] == registry.components("robot")
    robots = listed.of("robot")
    assert listed.known == robots
    assert asked == ["robot"]
    assert by_kind["planner"] == registry.components("planner")
    assert list(by_kind["metric"]) == sorted(registry.components("metric"))
    assert listed.of("planner") == listed[len(robots) : len(robots) + len(listed.of("planner"))]
    assert len(listed) == sum(len(by_kind[c]) for c in by_kind)
    assert asked == ["robot", "planner", "metric"]
    with pytest.raises(KeyError):
        by_kind["planer"]


def test_nothing_of_our_own_declares_data() -> None:
    """The hash of data is recorded of plugins only."""
    for plugin in found().plugins:
        assert [c.kind for c in plugin.components if declared_data(c.spec)] == []


def test_a_plugin_adds_its_components(tmp_path: Path) -> None:
    registry = found(plugin(tmp_path))
    component = registry.find("planner", "acme.go")
    assert registry.owner(component).pinned is False
    spec = component.spec.model_validate({"kind": "acme.go", "gain": 2.0})
    assert registry.build(spec, lambda built: built) == spec


def test_an_unknown_kind_names_near_ones() -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'dwa'"):
        found().find("planner", "dwaa")


VERSION = metadata.version("crowdbot")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("import no_such_module", "no_such_module"),
        ("raise SystemError('boo')", "boo"),
        ("def (", "SyntaxError"),
        ("CROWDBOT_API = 2", f"plugin API 2; this crowdbot {VERSION} speaks 1"),
    ],
)
def test_a_broken_plugin_hurts_only_itself(text: str, message: str, tmp_path: Path) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text(text, encoding="utf-8")
    registry = found(broken, plugin(tmp_path))
    assert message in error_of(registry, "broken")
    assert "acme.go" in registry.components("planner")
    assert "dwa" in registry.components("planner")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"kind": "go"}, "must start with 'acme.'"),
        ({"kind": "dwa"}, "must start with 'acme.'"),
        ({"category": "robot"}, "acme.go is listed as a robot, but it is a planner"),
        ({"hook": "crowdbot_planers"}, "crowdbot_planers"),
    ],
)
def test_wrong_components_disable_the_plugin(
    changes: dict[str, str], message: str, tmp_path: Path
) -> None:
    registry = found(plugin(tmp_path, **changes))
    assert message in error_of(registry, "acme")
    assert "acme.go" not in registry.components("planner")


def test_plugins_of_one_name_are_both_disabled(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    registry = found(plugin(tmp_path), plugin(tmp_path / "other"))
    assert "E301" in error_of(registry, "acme")
    assert str(tmp_path / "other") in error_of(registry, "acme")
    assert "acme.go" not in registry.components("planner")


def test_components_of_one_kind_are_all_disabled() -> None:
    dwa = found().find("planner", "dwa")
    plugins = [Plugin(name=n, distribution=f"{n} 1.0", components=(dwa,)) for n in ("a", "b")]
    for order in (plugins, plugins[::-1]):
        registry = assemble(order)
        assert registry.components("planner") == {}
        assert all("E301" in p.error for p in registry.plugins)
        assert all("a 1.0" in p.error and "b 1.0" in p.error for p in registry.plugins)


def test_allow_list(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CROWDBOT_PLUGINS", "nothing")
    assert [p.name for p in discover().plugins] == ["builtin"]
    assert [p.name for p in discover(allow=()).plugins] == ["builtin"]


def test_a_path_that_is_no_plugin(tmp_path: Path) -> None:
    registry = found(tmp_path / "nowhere.py")
    assert "no Python file or package" in error_of(registry, "nowhere")


def test_a_build_that_does_not_resolve(tmp_path: Path) -> None:
    path = plugin(tmp_path)
    path.write_text(path.read_text().replace("acme:build", "acme:bild"))
    with pytest.raises(PluginError, match=r"'acme\.go': build 'acme:bild' not found"):
        load_build(found(path).find("planner", "acme.go"))


def test_without_any_robot_the_message_names_the_broken_plugin() -> None:
    registry = assemble([Plugin(name="x", distribution="x 1", error="ImportError: no y")])
    with pytest.raises(PluginError, match=r"no .* is installed.*x \(ImportError: no y\)"):
        _ = registry.scenario_model


def test_a_kind_of_ours_that_cannot_be_loaded_says_why() -> None:
    broken = Plugin(name="builtin", distribution="crowdbot 1", error="metric: it has no card")
    registry = assemble([broken])
    with pytest.raises(UnknownNameError, match=r"cannot be loaded: metric: it has no card"):
        registry.find("metric", "success")
