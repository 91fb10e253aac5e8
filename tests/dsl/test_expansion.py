from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.text.diagnostics import render
from crowdbot.errors import SpecError, UsageError
from tests.paths import DATA

REGISTRY = discover(allow=())
PARTS = DATA / "diagnostics" / "parts"
SUITE = """\
crowdbot: 1
suite: {id: s, seed: 7}
base: {extends: parts/minimal.yaml}
"""

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "minimal.yaml").write_bytes((PARTS / "minimal.yaml").read_bytes())

    def to_file(text: str, name: str = "s.yaml") -> Path:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text, encoding="utf-8")
        return path

    return to_file


def expand(path: Path, *overrides: str, **roots: list[Path]) -> Expansion:
    return expand_document(load_document(path, roots), REGISTRY.scenario_model, overrides)


def headlines(path: Path, **roots: list[Path]) -> str:
    with pytest.raises(SpecError) as caught:
        expand(path, **roots)
    return render(caught.value.diagnostics)


@pytest.fixture(scope="module")
def challenge() -> Expansion:
    return open_spec("challenge-2020", REGISTRY)


def test_challenge_has_162_distinct_scenarios(challenge: Expansion) -> None:
    ids = [s.id for s in challenge.scenarios]
    hashes = {content_hash(s, REGISTRY.spec_versions(s)) for s in challenge.scenarios}
    assert len(ids) == len(set(ids)) == len(hashes) == 162
    assert (ids[0], ids[1], ids[-1]) == (
        "in-d0125-slow-c01-r02",
        "in-d0125-slow-c01-r05",
        "counter-d0500-dispersed-c50-r10",
    )
    assert challenge.suite_id == "challenge-2020"
    assert challenge.metrics is None


def test_challenge_shares_18_draws_and_references(challenge: Expansion) -> None:
    seeds = {s.crowd.seed for s in challenge.scenarios if s.crowd}
    assert {s.root for s in seeds} == {20200430}
    assert len(seeds) == 18
    last = challenge.scenarios[-1]
    assert last.crowd is not None
    assert last.crowd.seed.key == "counter-d0500-dispersed"
    assert set(last.references) == {"robot_alone", "crowd_alone"}
    assert last.references["robot_alone"].crowd is None
    assert last.references["robot_alone"].robots == last.robots
    assert last.references["crowd_alone"].robots == {}
    assert last.references["crowd_alone"].crowd == last.crowd
    assert {r.id for r in last.references.values()} == {last.id}


def test_no_two_scenarios_of_the_challenge_have_one_hash() -> None:
    scenarios = open_spec("challenge-2020", REGISTRY).scenarios
    assert len({content_hash(s, REGISTRY.spec_versions(s)) for s in scenarios}) == 162


def test_a_documents_own_seed_wins(write: Write) -> None:
    matrix = "matrix: {x: {x1: {crowd.seed.key: mine}, x2: {}}}\n"
    one, two = expand(write(SUITE + matrix)).scenarios
    assert one.crowd is not None
    assert two.crowd is not None
    assert (one.crowd.seed.root, one.crowd.seed.key) == (7, "mine")
    assert (two.crowd.seed.root, two.crowd.seed.key) == (7, "x2")


def test_seed_axes_are_in_the_matrix_order(write: Write) -> None:
    text = "matrix: {x: {x1: {}}, y: {y1: {}}, z: {z1: {}}}\nseeds: {crowd: [z, x]}\n"
    (scenario,) = expand(write(SUITE + text)).scenarios
    assert scenario.crowd is not None
    assert scenario.crowd.seed.key == "x1-z1"


def test_precedence(write: Write) -> None:
    write("crowd.speed: {mean: 2, std: 0.2}\n", "parts/two.yaml")
    text = SUITE.replace("parts/minimal.yaml", "[parts/minimal.yaml, parts/two.yaml]")
    path = write(text + "matrix: {m: {a: {}, b: {crowd.speed.mean: 3}}}\n")
    means = [s.crowd.speed.mean for s in expand(path).scenarios if s.crowd and s.crowd.speed]
    assert means == [2.0, 3.0]
    means = [
        s.crowd.speed.mean
        for s in expand(path, "crowd.speed.mean=4 km/h").scenarios
        if s.crowd and s.crowd.speed
    ]
    assert means == pytest.approx([4 / 3.6] * 2)


def test_override_changes_id_and_hash(write: Write) -> None:
    path = write(SUITE + "matrix: {m: {a: {}}}\n")
    (plain,) = expand(path).scenarios
    (changed,) = expand(path, "rates.log=8 Hz", "crowd.body={radius: 30 cm}").scenarios
    assert changed.id[:2] == "a+"
    assert len(changed.id) == len("a+1234")
    assert changed.rates.log == 8.0
    assert changed.crowd is not None
    assert changed.crowd.body.radius == 0.3
    assert content_hash(plain, {}) != content_hash(changed, {})


@pytest.mark.parametrize("text", ["no-equals", "=3", "id=x", "references={}"])
def test_bad_override_is_a_usage_error(write: Write, text: str) -> None:
    with pytest.raises(UsageError, match="--set"):
        expand(write(SUITE), text)


def test_errors_of_overrides_point_into_them(write: Write) -> None:
    path = write(SUITE)
    for text, place in [("crowd.sped=1", "--set:1:7"), ("crowd.speed.mean=2 kg", "--set:1:18")]:
        with pytest.raises(SpecError) as caught:
            expand(path, text)
        assert str(caught.value).startswith(place)


def test_a_suite_without_matrix_has_the_suites_id(write: Write) -> None:
    assert [s.id for s in expand(write(SUITE)).scenarios] == ["s"]


def test_a_suite_may_extend_a_suite(write: Write) -> None:
    write(SUITE + "matrix: {m: {a: {}, b: {}}}\n")
    child = "crowdbot: 1\nextends: s.yaml\nsuite.id: t\nbase.crowd.speed.mean: 1.5\n"
    found = expand(write(child, "t.yaml"))
    assert found.suite_id == "t"
    assert [s.crowd.speed.mean for s in found.scenarios if s.crowd and s.crowd.speed] == [1.5, 1.5]


def test_sensor_is_removed_by_null(write: Write) -> None:
    text = """\
  robots.robot.sensors: {odometry: {kind: wheel_odometry}, lidar: {kind: lidar2d}}
"""
    path = write(
        SUITE.replace("base: {extends: parts/minimal.yaml}", "base:\n  extends: parts/minimal.yaml")
        + text
    )
    (scenario,) = expand(path, "robots.robot.sensors.lidar=").scenarios
    assert list(scenario.robots["robot"].sensors) == ["odometry"]


def test_order_of_keys_in_a_file_never_matters(write: Write) -> None:
    costs = (
        "{reflex: {kind: rvo}, aim: {kind: ttca_dca}}",
        "{aim: {kind: ttca_dca}, reflex: {kind: rvo}}",
    )
    crowds = [expand(write(SUITE), f"crowd.costs={c}").scenarios[0].crowd for c in costs]
    assert [list(c.costs) for c in crowds if c] == [["aim", "reflex"]] * 2


def test_a_link_out_of_the_folder_is_refused(write: Write, tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    path = write(SUITE.replace("parts/minimal.yaml", "link.yaml"), "inside/s.yaml")
    (inside / "link.yaml").symlink_to(tmp_path / "parts" / "minimal.yaml")
    assert "E203" in headlines(path)
    assert len(expand(path, acme=[tmp_path / "parts"]).scenarios) == 1


def test_packaged_parts(write: Write, tmp_path: Path) -> None:
    path = write(
        SUITE.replace("parts/minimal", "'acme:minimal").replace("yaml}", "yaml'}"), "x/s.yaml"
    )
    assert len(expand(path, acme=[tmp_path / "parts"]).scenarios) == 1
    assert "is the package providing 'acme' installed?" in headlines(path)
    assert "did you mean 'acme2'?" in headlines(path, acme2=[tmp_path])


def test_includes_are_relative_to_the_file_that_names_them(write: Write) -> None:
    write("extends: ../parts/minimal.yaml\n", "more/deep.yaml")
    path = write(SUITE.replace("parts/minimal.yaml", "more/deep.yaml"))
    assert len(expand(path).scenarios) == 1


def test_all_errors_at_once_sorted(write: Write) -> None:
    text = "matrix: {m: {a: {crowd.sped: 1}}}\nseeds: {crowd: [n]}\nmatrx: {}\n"
    shown = headlines(write(SUITE + text))
    assert [line.split("[")[1][:4] for line in shown.split("\n") if "error[" in line] == [
        "E204",
        "E208",
        "E102",
    ]


@pytest.mark.parametrize("error", [ZeroDivisionError("oops"), SystemExit(0), RecursionError()])
def test_validator_of_a_plugin_that_crashes_is_a_plugin_error(
    write: Write, error: BaseException
) -> None:
    from crowdbot.dsl.checks.pydantic_errors import validate
    from crowdbot.errors import PluginError

    class Broken(REGISTRY.scenario_model):  # type: ignore[name-defined, misc]
        @classmethod
        def model_validate(cls, *_: Any, **__: Any) -> Any:
            raise error

    tree = load_document(write(SUITE)).base
    with pytest.raises(PluginError, match=rf"{type(error).__name__}.*test_expansion\.py:\d+"):
        validate(Broken, {}, tree)


@pytest.mark.parametrize(
    ("extends", "code"),
    [
        ("x" * 5000, "E201"),
        ("loop.yaml", "E201"),
        ("parts", "E001"),
        ("''", "E001"),
        ("s.yaml", "E202"),
        ("'C:\\x.yaml'", "E203"),
        ("3", "E111"),
        ("[[parts/minimal.yaml]]", "E111"),
    ],
)
def test_odd_includes(write: Write, tmp_path: Path, extends: str, code: str) -> None:
    (tmp_path / "loop.yaml").symlink_to(tmp_path / "loop.yaml")
    shown = headlines(write(SUITE.replace("parts/minimal.yaml", extends)))
    assert f"error[{code}]" in shown
    if code == "E001":
        assert "included from" in shown


def test_dotted_keys_cannot_nest_deeper_than_brackets(write: Write) -> None:
    assert "E009" in headlines(write(SUITE + "a." * 400 + "a: 1\n"))
    key = "a." * 20 + "a"
    assert "E009" in headlines(write(SUITE + f"{key}: {{{key}: {{{key}: 1}}}}\n"))
