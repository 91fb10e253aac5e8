"""JSON Schemas, held against an independent validator and an independent YAML reader."""

from __future__ import annotations

import copy
import json
import random
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from crowdbot.cli.commands.extend.schema import build
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import canonical_bytes, dump_scenario_yaml
from crowdbot.dsl.text.plain_yaml import to_yaml
from crowdbot.errors import SpecError
from tests.paths import ROOT

# The validator leaves patterns to the cache of `re`, which holds 512; these schemas have thrice as
# many, so that each of them would be compiled whenever it is met: nine tenths of the time.
vars(re)["_MAXCACHE"] = 10_000

SPECS = ROOT / "scenario_specs"
GOLDEN = ROOT / "tests" / "data" / "diagnostics"
REGISTRY = discover(allow=())
#: Howtos whose own plugin, in the folder of the same name, knows the kinds in them.
PLUGINS = {"my_costs.yaml", "my_robots.yaml"}
#: How a planner of another environment is started: `crowdbot.core.planning` checks that, no schema.
STARTED = ("torch_planner.yaml",)
WRITTEN = sorted(
    file
    for file in [*SPECS.rglob("*.yaml"), *ROOT.glob("docs/*/files/*.yaml")]
    if file.name not in STARTED
    and file.parent.name != "plans"  # maps of ROS are YAML, too
    and file.name != "study.yaml"  # a document of another kind, which crowdbot study reads
)

#: Broken files that a schema takes: what it cannot say, and where validate says it.
BEYOND = {
    "E002": "no YAML",
    "E003": "a duplicate key is gone, or written twice in two forms",
    "E005": "tags likewise",
    "E006": "merge keys likewise",
    "E007": "several documents, or a directive",
    "E011_xml": "no YAML",
    "E010_draw": "a name that is taken only beside another key",
    "E015": "another file",
    "E016": "characters that are escaped",
    "E142": "what an environment is like",
    "E143": "where ways lead",
    "E144": "another file, or its text",
    "E145": "a place inside another",
    "E146": "a number that another part has",
    "E147": "a rule between parts",
    "E214": "a hash",
    "E215": "a hash",
    "E103": "fields may come from another file, so that none is required",
    "E115": "a rule between fields",
    "E102_document": "another file",
    "E102_routing_kind": "the kind may come from another file",
    "E120_included": "the error is in another file",
    "E130": "names that lead to zones",
    "E131": "a product of two fields",
    "E132": "a place outside another",
    "E133": "a rule between fields",
    "E134": "a rule between fields",
    "E135": "a rule between fields",
    "E136": "a product of fields",
    "E137": "a rule between fields",
    "E138": "equal numbers in two places",
    "E139": "distances between places",
    "E140": "names that lead to goal areas",
    "E141": "a rule between fields",
    "E201": "another file",
    "E202": "another file",
    "E203": "another file",
    "E205": "two axes",
    "E206": "other files",
    "E207": "a product of axes",
    "E208": "names that lead to axes",
    "E211": "what is left of a product",
    "E212": "another file",
}


@cache
def validator(document: str, *, canonical: bool = False) -> Any:
    schema = build(document, REGISTRY, canonical=canonical)
    return jsonschema.Draft202012Validator(schema)


def read(file: Path) -> Any:
    """YAML 1.2 by ruamel's own constructor, which shares nothing with crowdbot's reader."""
    return YAML(typ="safe", pure=True).load(file.read_bytes())


def kind_of(document: Any) -> str:
    if not isinstance(document, dict):
        return "suite"
    if "kind" in document:
        return "planner"
    if "crowdbot" not in document and not {"suite", "base", "scenario"} & set(document):
        return "part"
    return "scenario" if "scenario" in document and "suite" not in document else "suite"


def fits(document: Any) -> bool:
    return _is_json(document) and bool(validator(kind_of(document)).is_valid(document))


def _is_json(document: Any) -> bool:
    """Whether all keys are text, as those of JSON are."""
    if isinstance(document, dict):
        return all(isinstance(k, str) and _is_json(v) for k, v in document.items())
    return not isinstance(document, list) or all(map(_is_json, document))


@pytest.mark.slow
def test_schemas_are_schemas() -> None:
    """Definitions that several schemas have alike are checked in one of them."""
    checked: dict[str, Any] = {}

    def check(schema: dict[str, Any]) -> None:
        new = {name: d for name, d in schema["$defs"].items() if checked.get(name) != d}
        jsonschema.Draft202012Validator.check_schema({**schema, "$defs": new})
        checked.update(new)

    for document in ("suite", "scenario", "part", "planner"):
        schema = validator(document).schema
        check(schema)
        assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
        assert schema["$id"].startswith("urn:crowdbot:")
        assert schema["title"]
    canonical = validator("scenario", canonical=True).schema
    check(canonical)
    assert canonical["$id"].endswith("canonical:v1")


@pytest.mark.parametrize("file", WRITTEN, ids=lambda f: f.name)
def test_files_that_ship_fit_and_say_so(file: Path) -> None:
    document = read(file)
    schema = validator(kind_of(document))
    if file.name in PLUGINS:
        known = discover(allow=(), extra=[file.with_suffix("")])
        schema = jsonschema.Draft202012Validator(build(kind_of(document), known))
    errors = [e.message for e in schema.iter_errors(document)]
    assert errors == []
    first = file.read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("# yaml-language-server: $schema=")
    target = (file.parent / first.partition("=")[2]).resolve()
    assert target == (SPECS / "schema" / f"{kind_of(document)}.v1.schema.json").resolve()


BROKEN = [
    f
    for f in sorted(GOLDEN.glob("E*.yaml"))
    if not {f.stem, f.stem.partition("_")[0]} & set(BEYOND)
]


@pytest.mark.slow
@pytest.mark.parametrize("file", BROKEN, ids=lambda f: f.stem)
def test_broken_files_do_not_fit(file: Path) -> None:
    assert not fits(read(file))


@pytest.mark.slow
def test_the_list_of_what_schemas_cannot_say_is_not_too_long() -> None:
    files = list(GOLDEN.glob("E*.yaml"))
    codes = {name for f in files for name in (f.stem, f.stem.partition("_")[0])}
    taken = {name for f in files if _taken(f) for name in (f.stem, f.stem.partition("_")[0])}
    assert set(BEYOND) & codes == set(BEYOND) & taken


def _taken(file: Path) -> bool:
    try:
        return fits(read(file))
    except (YAMLError, ValueError):
        return True  # it never reaches a schema


# ------------------------------------------------------------------ mutations of valid documents
DOCUMENT: dict[str, Any] = {
    "crowdbot": 1,
    "suite": {"id": "s", "title": "t", "seed": 3},
    "base": {
        **read(GOLDEN / "parts" / "minimal.yaml"),
        "robots": {
            "robot": {
                "model": {"kind": "turtlebot2", "max_speed": "50 cm/s"},
                "sensors": {"front": {"kind": "lidar2d", "range_max": "8 m", "mount": {"x": 0.1}}},
                "task": {"start": ["1 m", 0, "0 deg"], "goal": {"zone": "goal"}},
            }
        },
        "rates": {"crowd": "16 Hz"},
        "contact.stiffness": "30 kN/m",
    },
    "matrix": {
        "flow": {"in": {"crowd.flow.direction": "in"}, "out": {"crowd.flow.direction": "counter"}},
        "range": {"r2": {"crowd.costs.reflex.range": "2 m"}},
    },
    "seeds": {"crowd": ["flow"]},
    "metrics": ["risk", "relative_*"],
    "references": {"robot_alone": {"crowd": None}, "crowd_alone": {"robots": {}}},
}
#: Of another JSON type than any field's. ``null`` is missing: it may mean the default.
RETYPES: tuple[Any, ...] = (True, "3 bananas", [[]], {"x": 1}, -3.5)
#: Retypes that only rules between fields, or names, decide.
CROSS = ("seeds.crowd", "task.start", ".x", ".y", "robot_alone", "crowd_alone", "goal.zone",
         "rates.crowd", "suite.seed", "suite.title", "portals", "flow.area")  # fmt: skip


#: Every label of the matrix writes these, so that nobody sees what stands in the base.
MASKED = ("base.crowd.flow.direction", "base.crowd.costs.reflex.range")


def places(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    for key, value in node.items() if isinstance(node, dict) else enumerate(node):
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def mutated(path: tuple[Any, ...], how: str, value: Any = None) -> dict[str, Any]:
    document = copy.deepcopy(DOCUMENT)
    node: Any = document
    for key in path[:-1]:
        node = node[key]
    if how == "drop":
        del node[path[-1]]
    elif how == "rename":
        node[f"{path[-1]}x"] = node.pop(path[-1])
    else:
        node[path[-1]] = value
    return document


def mutations() -> Iterator[tuple[str, dict[str, Any]]]:
    for path in places(DOCUMENT):
        name = ".".join(map(str, path))
        if name.startswith(MASKED):
            continue
        if isinstance(path[-1], str):
            yield f"drop {name}", mutated(path, "drop")
            yield f"rename {name}", mutated(path, "rename")
        for value in RETYPES:
            yield f"retype {name} {value!r}", mutated(path, "retype", value)


def is_valid(document: Any, file: Path) -> bool:
    file.write_text(to_yaml(document), encoding="utf-8")
    try:
        open_spec(str(file), REGISTRY)
    except SpecError:
        return False
    return True


def test_the_document_is_valid_both_ways(tmp_path: Path) -> None:
    assert is_valid(DOCUMENT, tmp_path / "d.yaml")
    assert fits(DOCUMENT)


@pytest.mark.slow
def test_what_the_schema_refuses_validate_refuses(tmp_path: Path) -> None:
    """An editor never underlines what works; and mistakes of type it underlines all.

    Every fourth mutation: all of them take half a minute.
    """
    refused, missed = 0, []
    for name, document in list(mutations())[::4]:
        fit, valid = bool(validator("suite").is_valid(document)), None
        if not fit:
            refused += 1
            valid = is_valid(document, tmp_path / "d.yaml")
            assert not valid, f"{name}: the schema refuses what validate takes"
        elif name.startswith("retype") and not any(c in name for c in CROSS):
            valid = is_valid(document, tmp_path / "d.yaml")
            if not valid:
                missed.append(name)
    assert refused > 75
    assert missed == []


@pytest.mark.slow
def test_random_pairs_of_mutations(tmp_path: Path) -> None:
    rng, listed = random.Random(7), list(mutations())
    for _ in range(60):
        _, document = rng.choice(listed)
        (path,) = rng.sample(list(places(document)), 1)
        node: Any = document
        for key in path[:-1]:
            node = node[key]
        node[path[-1]] = rng.choice(RETYPES)
        if not (validator("suite").is_valid(document) or path[:1] == ("base",)):
            assert not is_valid(document, tmp_path / "d.yaml")


# ----------------------------------------------------------------------------- what editors offer
@pytest.mark.parametrize(
    ("base", "fit"),
    [
        ({"crowd.flow.density": "0.5 1/m^2"}, True),
        ({"crowd.flow.density": "0.5 kg"}, False),
        ({"crowd.flow.denisty": 0.5}, False),
        ({"crowd": {"flow.density": 0}}, False),
        ({"crowd.costs.mid_term.range": "5 m"}, True),
        ({"crowd.costs.mid_term": {"kind": "ttca_dca", "range": {"value": 5}}}, True),
        ({"crowd.costs.mid_term": {"kind": "rvo", "sigma_ttca": 1}}, False),
        ({"crowd.costs.mid_term": {"sigma_ttca": 1}}, True),
        ({"crowd.costs.mid_term": {"kind": "rv"}}, False),
        ({"crowd.costs": {"mid_term.weight": 3}}, True),
        ({"crowd.costs": {"mid_term.wieght": 3}}, False),
        ({"robots.robot.task.start": [0, 0, "90 deg"]}, True),
        ({"robots.robot.task.start": [0, 0]}, False),
        ({"robots.robot.sensors.front.mount.yaw": "90 °"}, True),
        ({"robots.robot.sensors.front.mount.yaw": "90 m"}, False),
        ({"crowd": None, "crowd.body": None}, True),
        ({"extends": ["a.yaml", "builtin:b.yaml"]}, True),
        ({"extends": 3}, False),
        ({"id": "x"}, False),
    ],
    ids=str,
)
def test_dotted_keys_kinds_and_short_forms(base: dict[str, Any], fit: bool) -> None:
    assert fits({"crowdbot": 1, "suite": {"id": "s"}, "base": base}) is fit


def test_every_field_of_a_component_has_a_description() -> None:
    parts = validator("suite").schema["$defs"]
    for kind, category in (("LIDAR", "sensors"), ("TTCA", "costs")):
        assert kind
        for case in parts[category]["allOf"][:-1]:
            model = parts[case["then"]["$ref"].rpartition("/")[2]]
            for name, field in model["properties"].items():
                assert name == "kind" or field.get("description"), name
                assert "default" in field or name == "kind"


@pytest.mark.parametrize(
    ("document", "fit"),
    [
        ({"kind": "dwa"}, True),
        ({"kind": "stop_and_go", "gap": 1}, False),
        ({"kind": "dwaa"}, False),
        ({"max_speed": 1}, False),
        ({"kind": "dwa", "horizon": None}, False),
        ({"kind": "dwa", "nothing.at.all": 1}, False),
    ],
    ids=str,
)
def test_planner_files(document: dict[str, Any], fit: bool) -> None:
    assert validator("planner").is_valid(document) is fit


def _needs_more(spec: Any) -> bool:
    return any(field.is_required() for field in spec.model_fields.values())


@pytest.mark.parametrize("kind", REGISTRY.components("planner"))
def test_every_planner_with_its_defaults_fits(kind: str) -> None:
    component = REGISTRY.find("planner", kind)
    given = next(iter(component.examples), {}) if _needs_more(component.spec) else {}
    spec = component.spec.model_validate({"kind": kind, **given})
    whole = spec.model_dump(mode="json")
    assert validator("planner").is_valid(whole)
    assert validator("planner", canonical=True).is_valid(whole)
    if len(whole) > 1:
        assert not validator("planner", canonical=True).is_valid({"kind": kind})


# ------------------------------------------------------------------------------- canonical form
@pytest.mark.slow
def test_resolved_scenarios_fit_the_canonical_schema() -> None:
    for scenario in open_spec("challenge-2020", REGISTRY).scenarios[::20]:
        text = dump_scenario_yaml(scenario, REGISTRY.spec_versions(scenario))
        document = YAML(typ="safe", pure=True).load(text)
        errors = validator("scenario", canonical=True).iter_errors(document)
        assert [e.message for e in errors] == []


def test_the_canonical_schema_takes_nothing_else() -> None:
    scenario = open_spec("challenge-2020", REGISTRY).scenarios[0]
    content = json.loads(canonical_bytes(scenario, {}))
    del content["kinds"]
    whole: dict[str, Any] = {"crowdbot": 1, "scenario": {**content, "id": "x", "title": ""}}
    check = validator("scenario", canonical=True)
    assert check.is_valid(whole)
    quantity, partial = copy.deepcopy(whole), copy.deepcopy(whole)
    quantity["scenario"]["crowd"]["body"]["radius"] = "33 cm"
    del partial["scenario"]["rates"]
    assert not check.is_valid(quantity)
    assert not check.is_valid(partial)
