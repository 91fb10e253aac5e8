"""Specs that do in their own code what nobody expects of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.cli.commands.extend.schema import build
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.core.registry.schema_check import describable
from crowdbot.errors import PluginError
from tests.core.registry.test_editable import install

HOOK = "__get_pydantic_json_schema__ = classmethod(lambda *_: exit(3))"
SAYS = "model_post_init = lambda self, context: exit(4)"
AGAIN = "model_post_init = lambda self, context: Spec()"


def test_a_plugin_without_a_schema_is_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(tmp_path, "mute", editable=False, data=HOOK)
    install(tmp_path, "good", editable=False)
    monkeypatch.syspath_prepend(str(tmp_path))
    found = discover(allow=["mute", "good"])
    assert not any(p.error for p in found.plugins)
    left = describable(found)
    errors = {p.name: p.error for p in left.plugins if p.error}
    assert list(errors) == ["mute"]
    assert "mute.wait: its JSON Schema cannot be made: SystemExit: 3" in errors["mute"]
    text = str(build("planner", left))
    assert "good.wait" in text
    assert "mute.wait" not in text


def test_others_stay_the_same() -> None:
    found = discover(allow=())
    assert describable(found) is found


@pytest.mark.parametrize(
    ("name", "code", "expected"),
    [("says", SAYS, "SystemExit: 4"), ("loops", AGAIN, "RecursionError: .*loops_plug")],
)
def test_parameters_whose_code_leaves_or_never_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, code: str, expected: str
) -> None:
    install(tmp_path, name, editable=False, data=code)
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match=f"planner '{name}.wait'.*{expected}"):
        resolve_planner(f"{name}.wait", discover(allow=[name]))
