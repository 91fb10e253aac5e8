"""Commit and reveal, as documents read it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import installed
from crowdbot.dsl.suite.commitment import commitment_of, committed_content
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import SpecError
from tests.paths import DATA

REGISTRY = discover(allow=())
PARTS = DATA / "diagnostics" / "parts"
SALT = "0123456789abcdef0123456789abcdef"
HEAD = "crowdbot: 1\nsuite: {id: s}\nbase: {extends: minimal.yaml}\ndraws: 2\n"
OPEN = HEAD.replace("{id: s}", "{id: s, seed: 7}")

Expand = Callable[..., Expansion]


@pytest.fixture
def expand(tmp_path: Path) -> Expand:
    for part in ("minimal.yaml", "suite.yaml"):
        (tmp_path / part).write_bytes((PARTS / part).read_bytes())

    def it(text: str, *overrides: str, name: str = "s.yaml") -> Expansion:
        file = tmp_path / name
        file.write_text(text, encoding="utf-8")
        suite = load_document(file, installed=installed(REGISTRY))
        return expand_document(suite, REGISTRY.scenario_model, overrides)

    return it


@pytest.fixture
def content(tmp_path: Path) -> dict[str, object]:
    (tmp_path / "minimal.yaml").write_bytes((PARTS / "minimal.yaml").read_bytes())
    (tmp_path / "c.yaml").write_text(HEAD)
    return committed_content(load_document(tmp_path / "c.yaml").tree)


def revealed(commitment: str, seed: int = 7, salt: str = SALT, head: str = HEAD) -> str:
    return f'{head}suite.commitment: {commitment}\nsuite.seed: {seed}\nsuite.salt: "{salt}"\n'


def codes(error: SpecError) -> list[str]:
    return [d.code for d in error.diagnostics]


def test_what_fits_is_the_suite_as_it_was(expand: Expand, content: dict[str, object]) -> None:
    found = expand(revealed(commitment_of(content, 7, SALT)))
    assert found.commitment.startswith("sha256:")
    assert found.scenarios == expand(OPEN).scenarios
    assert not any(s.hidden for s in found.scenarios)


@pytest.mark.parametrize(
    "change",
    [
        {"seed": 8},
        {"salt": SALT.replace("0", "1", 1)},
        {"head": HEAD.replace("draws: 2", "draws: 3")},
        {"head": HEAD.replace("id: s", "id: t")},
        {"head": HEAD + "metrics: [success]\n"},
        {"head": HEAD + "base.crowd.speed.mean: 1\n"},
    ],
)
def test_whatever_is_changed_is_found(
    change: dict[str, object], expand: Expand, content: dict[str, object]
) -> None:
    text = revealed(commitment_of(content, 7, SALT), **change)  # type: ignore[arg-type]
    with pytest.raises(SpecError) as caught:
        expand(text)
    assert codes(caught.value) == ["E214"]
    (found,) = caught.value.diagnostics
    assert text.split("\n")[found.mark.line].startswith("suite.commitment")


def test_an_included_file_that_changed_is_found(
    expand: Expand, content: dict[str, object], tmp_path: Path
) -> None:
    part = tmp_path / "minimal.yaml"
    part.write_text(part.read_text() + "\ncontact.stiffness: 20 N/mm\n")
    with pytest.raises(SpecError) as caught:
        expand(revealed(commitment_of(content, 7, SALT)))
    assert codes(caught.value) == ["E214"]


def test_comments_and_order_may_change(expand: Expand, content: dict[str, object]) -> None:
    lines = HEAD.splitlines()
    head = "\n".join(["# why", lines[0], *reversed(lines[1:])]) + "\n"
    assert expand(revealed(commitment_of(content, 7, SALT), head=head)).scenarios


def test_hidden_draws_have_conditions_and_no_people(expand: Expand) -> None:
    found = expand(HEAD + f"suite.commitment: sha256:{'a' * 64}\n")
    assert [s.id for s in found.scenarios] == ["s-n01", "s-n02"]
    assert all(s.hidden == f"sha256:{'a' * 64}" for s in found.scenarios)


def test_who_has_a_seed_of_its_own_is_not_hidden(expand: Expand) -> None:
    found = expand(HEAD + f"suite.commitment: sha256:{'a' * 64}\n", "crowd.seed.root=3")
    assert not any(s.hidden for s in found.scenarios)
    seeds = [s.crowd.seed for s in found.scenarios if s.crowd]
    assert [(s.root, s.key) for s in seeds] == [(3, "n01"), (3, "n02")]


def test_references_with_people_are_hidden_those_without_are_not(expand: Expand) -> None:
    text = (
        HEAD + f"suite.commitment: sha256:{'a' * 64}\nreferences: {{a: {{}}, b: {{crowd: null}}}}\n"
    )
    references = expand(text).scenarios[0].references
    assert {name: bool(s.hidden) for name, s in references.items()} == {"a": True, "b": False}


def test_the_seed_of_an_included_suite_is_not_the_hidden_one(expand: Expand) -> None:
    expand("crowdbot: 1\nsuite: {id: p, seed: 5}\nbase: {extends: minimal.yaml}\n", name="p.yaml")
    found = expand(f"extends: p.yaml\nsuite: {{id: q, commitment: 'sha256:{'a' * 64}'}}\n")
    assert all(s.hidden for s in found.scenarios)


def test_who_extends_a_revealed_suite_is_told_how(
    expand: Expand, content: dict[str, object]
) -> None:
    expand(revealed(commitment_of(content, 7, SALT)), name="p.yaml")
    with pytest.raises(SpecError) as caught:
        expand("extends: p.yaml\nsuite.id: child\n")
    assert codes(caught.value) == ["E214"]
    assert "commitment: null" in caught.value.diagnostics[0].hint
    child = expand("extends: p.yaml\nsuite: {id: child, commitment: null, salt: null, seed: 7}\n")
    assert child.scenarios == expand(OPEN.replace("id: s", "id: child")).scenarios


@pytest.mark.parametrize(
    ("lines", "code"),
    [
        (f'suite.salt: "{SALT}"', "E215"),
        (f"suite.commitment: sha256:{'a' * 64}\nsuite.seed: 7", "E215"),
        (f"suite.commitment: sha256:{'a' * 64}\nsuite.salt: '{SALT}'", "E215"),
        ("suite.commitment: sha256:aa", "E116"),
        ("suite.commitment: 12", "E111"),
        (f"suite.commitment: sha256:{'a' * 64}\nsuite.seed: 7\nsuite.salt: abc", "E116"),
        (f"suite.commitment: sha256:{'a' * 64}\nsuite.seed: x\nsuite.salt: '{SALT}'", "E111"),
    ],
)
def test_half_a_reveal_is_an_error(lines: str, code: str, expand: Expand) -> None:
    with pytest.raises(SpecError) as caught:
        expand(HEAD + lines + "\n")
    assert code in codes(caught.value)


def test_a_typed_salt_is_refused_though_it_fits(expand: Expand, content: dict[str, object]) -> None:
    salt = "0" * 31 + "1"
    with pytest.raises(SpecError) as caught:
        expand(revealed(commitment_of(content, 7, salt), salt=salt))
    assert codes(caught.value) == ["E215"]
    assert "trying" in caught.value.diagnostics[0].message


_SEEDS = st.integers(0, 2**63 - 1)
_SALTS = st.integers(0, 2**128).map(lambda number: f"{number:032x}")


@given(_SEEDS, _SEEDS, _SALTS)
def test_seed_and_salt_do_not_run_into_each_other(one: int, two: int, salt: str) -> None:
    """``seed 1, salt 23`` is not ``seed 12, salt 3``, as it would be in a hash of joined texts."""
    same = one == two
    assert (commitment_of({}, one, salt) == commitment_of({}, two, salt)) is same
    assert commitment_of({}, one, salt) != commitment_of({}, one, salt + "0")
    assert commitment_of({"a": salt}, one, "") != commitment_of({}, one, salt)


def test_the_form_of_a_commitment_is_fixed() -> None:
    """A release that computed it otherwise could not check what an older one has published."""
    assert commitment_of({"suite": {"id": "é"}, "a": [1, 1.0, True, None]}, 7, SALT) == (
        "sha256:81e9f2fe06b152edd1be14ab285d236aefe0dfa9d3518aa9eee80c4c5c3046b0"
    )
