"""Components that are made of others: parts are built first, in any category."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import ValidationError

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.dsl.scenario.components import components
from crowdbot.dsl.scenario.scenario import Scenario
from tests.core.sim.sim_worlds import scenario

PLUGIN = '''
from typing import Any, ClassVar, Literal
from pydantic import Field, SerializeAsAny
from crowdbot.plugin import Component, CrowdPolicySpec, CostFunctionSpec, NoiseSpec, SensorSpec
from crowdbot.plugin import hookimpl

class MixSpec(CrowdPolicySpec):
    """A policy of costs of its own."""
    kind: Literal["made.mix"] = "made.mix"
    terms: dict[str, SerializeAsAny[PART]] = Field(default={}, description="Costs.")
    parts_field: ClassVar[str] = "FIELD"

def build(spec, terms, costs=None, agents=None):
    return [spec.kind, *terms]

@hookimpl
def crowdbot_components():
    return {"crowd policy": [Component(spec=MixSpec, build="made:build", summary="a mix")]}
'''


@pytest.fixture
def found(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Registry]:
    part, field = getattr(request, "param", ("CostFunctionSpec", "terms"))
    path = tmp_path / "made.py"
    path.write_text(PLUGIN.replace("PART", part).replace("FIELD", field))
    yield discover(extra=[path], allow=())
    sys.modules.pop("made", None)


TERMS = {"b": {"kind": "rvo"}, "a": {"kind": "moussaid"}}


def test_parts_are_validated_and_built_first_in_the_order_of_names(found: Registry) -> None:
    model = found.spec_model("crowd policy", "made.mix")
    spec = model.model_validate({"kind": "made.mix", "terms": TERMS})
    assert {n: s.kind for n, s in spec.parts().items()} == {"b": "rvo", "a": "moussaid"}
    kind, *built = found.build(spec, lambda made: list(made))  # type: ignore[call-overload]
    assert kind == "made.mix"
    costs = [found.build(spec.parts()[name], lambda made: made) for name in ("a", "b")]
    assert [type(b) for b in built] == [type(c) for c in costs]
    assert [b.base for b in built] == [c.base for c in costs]  # type: ignore[attr-defined]
    with pytest.raises(ValidationError, match="no_such"):
        model.model_validate({"kind": "made.mix", "terms": {"a": {"kind": "no_such"}}})


def test_without_any_the_build_function_gets_an_empty_list(found: Registry) -> None:
    spec = found.spec_model("crowd policy", "made.mix").model_validate({"kind": "made.mix"})
    assert found.build(spec, lambda made: made) == ["made.mix"]


def test_they_are_components_of_the_scenario(found: Registry) -> None:
    document = scenario().model_dump(mode="json")
    document["crowd"]["policy"] = {"kind": "made.mix", "terms": TERMS}
    validated: Scenario = found.scenario_model.model_validate(document)
    paths = {path: spec.kind for path, spec in components(validated)}
    assert paths["crowd", "policy", "terms", "a"] == "moussaid"
    assert found.spec_versions(validated)["moussaid"] == 1


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (("CrowdPolicySpec", "terms"), "a crowd policy cannot have parts of the category 'crowd p"),
        (("SensorSpec", "terms"), "'sensor'; what it can have: cost function, metric"),
        (("CostFunctionSpec", "kind"), "parts_field: 'kind' is not a field of dict"),
        (("CostFunctionSpec", "items"), "parts_field: 'items' is not a field of dict"),
    ],
    indirect=["found"],
)
def test_a_plugin_whose_parts_cannot_be_is_disabled(found: Registry, expected: str) -> None:
    (made,) = (p for p in found.plugins if p.name == "made")
    assert made.error.startswith("made.mix: ")
    assert expected in made.error
    assert found.find("crowd policy", "velocity_space")
