"""Crowds by name, and the same scenarios with other crowds."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.realism.crowds import different_crowds, known, lines_of
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.named_crowds import crowd_parts, names_crowd, open_crowd
from crowdbot.core.scenarios.with_crowds import with_crowds
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.errors import InputError, SpecError, UnknownNameError

REGISTRY = discover(allow=())
PARTS = sorted(crowd_parts(REGISTRY))


def test_crowds_by_name_by_file_and_by_kind(tmp_path: Path) -> None:
    parts = crowd_parts(REGISTRY)
    assert {"calibrated", "orca", "challenge_2020"} <= set(parts)
    copied = tmp_path / "mine.yaml"
    copied.write_text(parts["power_law"].read_text())
    same = open_crowd("power_law", REGISTRY)
    assert fingerprint(open_crowd(str(copied), REGISTRY)) == fingerprint(same)
    assert same.speed is not None
    assert same.speed.mean == 1.5
    assert names_crowd("jupedsim", REGISTRY)
    assert names_crowd(str(copied), REGISTRY)
    assert not names_crowd("challenge-2020", REGISTRY)


def test_settings_of_a_crowd_may_leave_crowd_out() -> None:
    changed = open_crowd("orca", REGISTRY, ["speed.mean=1.2 m/s", "crowd.body.radius=0.25 m"])
    assert changed.speed is not None
    assert (changed.speed.mean, changed.body.radius) == (1.2, 0.25)


def test_wrong_names_fields_and_files_are_told(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'orca'"):
        open_crowd("orka", REGISTRY)
    with pytest.raises(InputError, match="no such file"):
        open_crowd(str(tmp_path / "nothing.yaml"), REGISTRY)
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("crowd:\n  policy: {kind: velocity_spice}\n")
    with pytest.raises(SpecError) as caught:
        open_crowd(str(wrong), REGISTRY)
    assert caught.value.diagnostics[0].mark is not None
    assert caught.value.diagnostics[0].mark.line == 1  # counted from 0
    assert caught.value.diagnostics[0].mark.source.name == str(wrong)


def test_scenarios_with_other_crowds() -> None:
    plain = open_spec("challenge-2026", REGISTRY, ["crowd.body.radius=0.3 m"])
    found = with_crowds(plain, ["orca", "calibrated"], REGISTRY)
    assert len(found.scenarios) == 2 * len(plain.scenarios)
    first, own = found.scenarios[0], plain.scenarios[0]
    assert first.id == f"{own.id}+orca"
    assert found.axes[first.id] == {**plain.axes[own.id], "crowd": "orca"}
    assert first.crowd is not None
    assert own.crowd is not None
    assert first.crowd.policy != own.crowd.policy
    assert first.crowd.steering is None
    assert (first.crowd.flow, first.crowd.speed) == (own.crowd.flow, own.crowd.speed)
    assert first.crowd.robot_response == own.crowd.robot_response
    assert (first.crowd.contact_dissipation, own.crowd.contact_dissipation) == (3.0, 0.0)
    calibrated = found.scenarios[len(plain.scenarios)]
    assert calibrated.crowd is not None
    assert calibrated.crowd.steering is not None
    assert calibrated.crowd.body.radius != own.crowd.body.radius
    assert first.references["crowd_alone"].crowd == first.crowd
    assert first.references["robot_alone"].crowd is None
    assert len(different_crowds(found.scenarios)) == 2


def test_what_cannot_have_other_crowds_is_refused() -> None:
    plain = open_spec("challenge-2026", REGISTRY)
    assert with_crowds(plain, [], REGISTRY) is plain
    with pytest.raises(InputError, match="has an axis 'crowd' already"):
        with_crowds(with_crowds(plain, ["orca"], REGISTRY), ["rvo"], REGISTRY)
    alone = open_spec("challenge-2026", REGISTRY, ["crowd=null"])
    with pytest.raises(InputError, match="has no crowd"):
        with_crowds(alone, ["orca"], REGISTRY)


def test_lines_of_a_report() -> None:
    (line,) = lines_of([("calibrated", ""), ("calibrated", "")])
    assert line.startswith("calibrated, realism 0.8")
    assert "no avoidance 0.5" in line
    assert lines_of([("", "0" * 16), ("", "1" * 16)]) == [
        "2 crowds; how real these people are was not measured (crowdbot realism SUITE)"
    ]


def test_what_is_known_of_packaged_crowds_was_measured_with_their_fields() -> None:
    """After a change of a part: `scripts/write_crowd_validation.py NAME`."""
    known_now = {name: known().get(fingerprint(open_crowd(name, REGISTRY)), {}) for name in PARTS}
    assert {name: row.get("name") for name, row in known_now.items()} == {n: n for n in PARTS}
