"""Planners of plugins, which the simulator loads, are verified only if the plugin is trusted."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from crowdbot.cli.commands.challenge.verify import _trusting
from crowdbot.core.bundle.rerun_verdict import RerunVerdict
from crowdbot.core.registry.registry import Registry, discover
from tests.cli.plugin_packages import planner


@pytest.fixture(scope="module")
def registry(tmp_path_factory: pytest.TempPathFactory) -> Registry:
    file = tmp_path_factory.mktemp("plugin") / "untrusted_one.py"
    file.write_text(planner("untrusted_one.go", "untrusted_one:build") + "\ndef build(spec): ...\n")
    return discover(extra=[file])


def _outcome(registry: Registry, kind: str, *trusted: str, of: Any = "verified") -> tuple[str, str]:
    archive: Any = SimpleNamespace(manifest=SimpleNamespace(planner={"kind": kind}))
    found = _trusting(archive, registry, RerunVerdict(outcome=of), trusted)
    return found.outcome, " ".join(found.findings)


def test_a_planner_of_a_plugin_is_not_trusted_unasked(registry: Registry) -> None:
    outcome, why = _outcome(registry, "untrusted_one.go")
    assert outcome == "untrusted plugin"
    assert "--trust untrusted_one" in why


def test_a_trusted_plugin_and_our_own_planners_are_fine(registry: Registry) -> None:
    assert _outcome(registry, "untrusted_one.go", "untrusted_one") == ("verified", "")
    assert _outcome(registry, "dwa") == ("verified", "")
    assert _outcome(registry, "mine.py:Mine") == ("verified", "")


def test_another_outcome_stays(registry: Registry) -> None:
    assert _outcome(registry, "untrusted_one.go", of="suspicious") == ("suspicious", "")


def test_each_planner_of_a_fleet_counts(registry: Registry) -> None:
    robots = {"a": {"kind": "dwa"}, "b": {"kind": "untrusted_one.go"}}
    archive: Any = SimpleNamespace(
        manifest=SimpleNamespace(planner={"kind": "fleet", "robots": robots})
    )
    found = _trusting(archive, registry, RerunVerdict(outcome="within tolerance"), ())
    assert found.outcome == "untrusted plugin"
