"""Suites of suites: selections, draws, and what is laid over what."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import installed, open_spec
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.text.diagnostics import render
from crowdbot.errors import SpecError
from tests.paths import DATA

REGISTRY = discover(allow=())
PARTS = DATA / "diagnostics" / "parts"
HEAD = "crowdbot: 1\nsuite: {id: s, seed: 7}\nbase: {extends: minimal.yaml}\n"
MATRIX = "matrix:\n  pace: {slow: {crowd.speed.mean: 1}, fast: {crowd.speed.mean: 2}}\n"
AXES = MATRIX + "  flow: {in: {crowd.flow.direction: in}, back: {crowd.flow.direction: counter}}\n"

Expand = Callable[..., Expansion]


@pytest.fixture
def expand(tmp_path: Path) -> Expand:
    for part in ("minimal.yaml", "suite.yaml"):
        (tmp_path / part).write_bytes((PARTS / part).read_bytes())

    def it(text: str, *overrides: str) -> Expansion:
        file = tmp_path / "s.yaml"
        file.write_text(text, encoding="utf-8")
        suite = load_document(file, installed=installed(REGISTRY))
        return expand_document(suite, REGISTRY.scenario_model, overrides)

    return it


def ids(expansion: Expansion) -> list[str]:
    return [s.id for s in expansion.scenarios]


def hashes(expansion: Expansion) -> dict[str, str]:
    return {s.id: content_hash(s, REGISTRY.spec_versions(s)) for s in expansion.scenarios}


@pytest.mark.parametrize(
    ("selection", "kept"),
    [
        ("only: {pace: slow}", ["slow-in", "slow-back"]),
        ("only: [{pace: slow, flow: in}, {pace: fast, flow: back}]", ["slow-in", "fast-back"]),
        ("exclude: {flow: [in]}", ["slow-back", "fast-back"]),
        ("only: {pace: [slow, fast]}\nexclude: {pace: slow, flow: in}",
         ["slow-back", "fast-in", "fast-back"]),
        ("exclude: [{pace: slow}, {flow: in}]", ["fast-back"]),
        ("only: null", ["slow-in", "slow-back", "fast-in", "fast-back"]),
    ],
)  # fmt: skip
def test_selection_keeps_ids_and_hashes(expand: Expand, selection: str, kept: list[str]) -> None:
    everything = hashes(expand(HEAD + AXES))
    chosen = hashes(expand(HEAD + AXES + selection + "\n"))
    assert list(chosen) == kept
    assert chosen == {id_: everything[id_] for id_ in kept}


def test_a_subset_of_the_challenge_is_three_lines(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        "extends: 'builtin:challenge-2020.yaml'\nsuite.id: mine\n"
        "only: {density: d0125, range: [r02, r05]}\n"
    )
    mine, whole = hashes(open_spec(str(file), REGISTRY)), hashes(
        open_spec("challenge-2020", REGISTRY)
    )  # fmt: skip
    assert len(mine) == 162 // 3 // 3 * 2
    assert mine.items() <= whole.items()


def test_to_the_letter_policies_see_the_robot_and_people_fill_the_loop() -> None:
    one, other = (open_spec(n, REGISTRY) for n in ("challenge-2020", "challenge-2020-letter"))
    assert [s.id for s in one.scenarios] == [s.id for s in other.scenarios]
    for scenario in other.scenarios:
        crowd = scenario.crowd
        assert crowd is not None
        assert crowd.flow is not None
        assert crowd.robot_response.shown_to_policies
        loop = scenario.environment.zones[crowd.flow.area]
        ends = [scenario.environment.portals[name] for name in "ab"]
        assert (loop.x, loop.y) == ((ends[0].x[0], ends[1].x[1]), (-5.0, 5.0))
        assert crowd.flow.density * loop.area in (65.0, 130.0, 260.0)


def test_the_literal_challenge_differs_in_one_field() -> None:
    one, other = (open_spec(n, REGISTRY) for n in ("challenge-2020", "challenge-2020-literal"))
    assert ids(one) == ids(other)
    assert other.suite_id == "challenge-2020-literal"
    for a, b in zip(one.scenarios, other.scenarios, strict=True):
        assert a.crowd is not None
        assert b.crowd is not None
        reflexes = [c.costs["reflex"].model_dump() for c in (a.crowd, b.crowd)]
        assert [r["range"]["measure"] for r in reflexes] == ["surface", "centre"]
        costs = {**b.crowd.costs, "reflex": a.crowd.costs["reflex"]}
        assert b.model_copy(
            update={"crowd": b.crowd.model_copy(update={"costs": costs})}
        ).model_dump() == a.model_dump()  # fmt: skip


def test_draws_draw_other_people(expand: Expand) -> None:
    found = expand(HEAD + AXES + "seeds: {crowd: [flow]}\ndraws: 2\n")
    assert ids(found)[:3] == ["slow-in-n01", "slow-in-n02", "slow-back-n01"]
    keys = {s.id: s.crowd.seed.key for s in found.scenarios if s.crowd}
    assert keys["slow-in-n01"] == keys["fast-in-n01"] == "in-n01"
    assert keys["slow-in-n02"] == "in-n02"


def test_more_draws_keep_the_first(expand: Expand) -> None:
    few, many = (hashes(expand(HEAD + MATRIX + f"draws: {n}\n")) for n in (3, 120))
    assert few.items() <= many.items()
    assert list(many)[119] == "slow-n120"


def test_one_draw_changes_nothing(expand: Expand) -> None:
    assert hashes(expand(HEAD + AXES)) == hashes(expand(HEAD + AXES + "draws: 1\n"))


def test_draws_without_matrix_and_with_a_key_of_ones_own(expand: Expand) -> None:
    text = HEAD.replace("}\n", "}\n", 1) + "draws: 2\n"
    assert ids(expand(text)) == ["s-n01", "s-n02"]
    seeds = [s.crowd.seed for s in expand(text, "crowd.seed.key=mine").scenarios if s.crowd]
    assert [(s.root, s.key) for s in seeds] == [(7, "mine-n01"), (7, "mine-n02")]


def test_draws_can_be_selected(expand: Expand) -> None:
    text = HEAD + MATRIX + "draws: 3\nonly: {draw: [n02]}\n"
    assert ids(expand(text)) == ["slow-n02", "fast-n02"]


def test_labels_and_axes_of_an_extended_suite_can_be_removed(expand: Expand) -> None:
    text = "extends: suite.yaml\nsuite.id: t\n" + AXES + "matrix.pace.slow: null\n"
    with pytest.raises(SpecError, match="E003"):  # twice in one file
        expand(text)
    base = expand("extends: suite.yaml\nsuite.id: t\n" + AXES)
    assert len(base.scenarios) == 4


def test_set_beats_reference_but_cannot_bring_back_what_it_removes(expand: Expand) -> None:
    text = HEAD + "references: {calm: {crowd.speed.mean: 0.5}, empty: {crowd: null}}\n"
    plain, changed = (expand(text, *o).scenarios[0] for o in ((), ("crowd.speed.mean=3",)))
    assert plain.references["calm"].crowd is not None
    assert plain.references["calm"].crowd.speed is not None
    assert plain.references["calm"].crowd.speed.mean == 0.5
    assert changed.references["calm"].crowd is not None
    assert changed.references["calm"].crowd.speed is not None
    assert changed.references["calm"].crowd.speed.mean == 3.0
    assert changed.references["empty"].crowd is None


def test_set_of_a_whole_crowd_does_not_undo_a_reference(expand: Expand) -> None:
    text = HEAD + "references: {empty: {crowd: null}, ghosts: {robots: {}}}\n"
    for change in ("crowd.body={radius: 0.3}", "robots.robot.task.time_limit=9"):
        refs = expand(text, change).scenarios[0].references
        assert refs["empty"].crowd is None
        assert refs["ghosts"].robots == {}


@pytest.mark.parametrize("layer", ["axis", "set", "reference"])
def test_a_changed_kind_discards_the_old_map_everywhere(expand: Expand, layer: str) -> None:
    new, text, overrides = "{kind: ttca_dca, weight: 3}", HEAD, []
    if layer == "axis":
        text += f"matrix: {{a: {{x: {{crowd.costs.reflex: {new}}}}}}}\n"
    elif layer == "set":
        overrides = [f"crowd.costs.reflex={new}"]
    else:
        text += f"references: {{r: {{crowd.costs.reflex: {new}}}}}\n"
    scenario = expand(text, *overrides).scenarios[0]
    crowd = (scenario.references["r"] if layer == "reference" else scenario).crowd
    assert crowd is not None
    assert crowd.costs["reflex"].kind == "ttca_dca"


def test_dotted_keys_may_stand_everywhere(expand: Expand) -> None:
    text = (
        "crowdbot: 1\nsuite.id: s\nsuite.seed: 7\nbase.extends: minimal.yaml\n"
        "base.crowd.speed.mean: 1\nmatrix.pace.slow.crowd.speed.std: 0.2\n"
        "references.alone.crowd: null\nseeds.crowd: [pace]\n"
    )
    (scenario,) = expand(text).scenarios
    assert scenario.id == "slow"
    assert scenario.references["alone"].crowd is None


def test_cycle_prints_the_chain(tmp_path: Path) -> None:
    for name, other in ("ab", "bc", "ca"):
        (tmp_path / f"{name}.yaml").write_text(f"extends: {other}.yaml\n")
    with pytest.raises(SpecError, match=r"a\.yaml -> b\.yaml -> c\.yaml -> a\.yaml"):
        load_document(tmp_path / "a.yaml")


@pytest.mark.parametrize(
    ("kinds", "text"),
    [
        ("{rvo: 2}", r"E014.*needs version 2 of 'rvo'; crowdbot \S+ has version 1"),
        ("{acme.omni: 1}", r"E120.*unknown kind 'acme.omni'"),
        ("{rvo: x}", "E111"),
        ("3", "E111"),
    ],
)
def test_versions_of_components(expand: Expand, kinds: str, text: str) -> None:
    with pytest.raises(SpecError, match=text):
        expand(HEAD + f"kinds: {kinds}\n")
    assert len(expand(HEAD + "kinds: {rvo: 1}\n").scenarios) == 1


def test_missing_plugin_is_named(expand: Expand) -> None:
    with pytest.raises(SpecError) as caught:
        expand(HEAD + "kinds: {acme.omni: 1}\n")
    shown = render(caught.value.diagnostics)
    assert "is the package providing 'acme' installed?" in shown
    assert ":4:9:" in shown


@pytest.mark.slow
def test_many_errors_in_many_combinations_end_soon(expand: Expand) -> None:
    axis = ", ".join(f"x{i}: {{}}" for i in range(100))
    fields = "".join(f"  foo{i}: 1\n" for i in range(800))
    text = HEAD.replace("{extends: minimal.yaml}", f"\n  extends: minimal.yaml\n{fields}")
    with pytest.raises(SpecError) as caught:
        expand(f"{text}matrix: {{a: {{{axis}}}, b: {{{axis}}}}}\n".replace("b: {x", "b: {y", 1))
    assert 1 <= len(caught.value.diagnostics) <= 1000


def test_labels_and_references_extend(expand: Expand, tmp_path: Path) -> None:
    """A label's own fields win over those of its file, which win over the base's."""
    (tmp_path / "hasty.yaml").write_text("crowd.speed: {mean: 2, std: 0.5}\n", encoding="utf-8")
    (tmp_path / "empty.yaml").write_text("crowd: null\n", encoding="utf-8")
    written = HEAD + (
        "matrix:\n  pace:\n    slow: {}\n    hasty: {extends: hasty.yaml, crowd.speed.std: 0.25}\n"
        "references:\n  robot_alone: {extends: empty.yaml}\n"
    )
    slow, hasty = (s.model_dump()["crowd"]["speed"] for s in expand(written).scenarios)
    assert (hasty["mean"], hasty["std"]) == (2.0, 0.25)
    assert slow != hasty
    assert expand(written).scenarios[0].references["robot_alone"].crowd is None
    plain = HEAD + (
        "matrix:\n  pace:\n    slow: {}\n    hasty: {crowd.speed: {mean: 2, std: 0.25}}\n"
        "references:\n  robot_alone: {crowd: null}\n"
    )
    assert hashes(expand(plain)) == hashes(expand(written))


def test_an_error_in_a_file_that_a_label_extends_is_shown_there(
    expand: Expand, tmp_path: Path
) -> None:
    (tmp_path / "hasty.yaml").write_text("crowd.speed.meen: 2\n", encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        expand(HEAD + "matrix:\n  pace:\n    hasty: {extends: hasty.yaml}\n")
    text = render(caught.value.diagnostics)
    assert "hasty.yaml:1:" in text
    assert "'mean'" in text
    assert "included from" in text
