from __future__ import annotations

import itertools
import re
import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from crowdbot.core.scenarios.library import open_spec, pick, select, suite_names
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError, SpecError, UnknownNameError
from tests.paths import DATA

REGISTRY = discover(allow=())
DATA = DATA / "diagnostics"
SUITE = "crowdbot: 1\nsuite: {id: office}\nbase: {extends: parts/minimal.yaml}\n"


@pytest.fixture(scope="module")
def challenge() -> Expansion:
    return open_spec("challenge-2020", REGISTRY)


def with_plugin(*folders: object) -> Registry:
    acme = Plugin(name="acme", distribution="crowdbot-acme 1", scenario_dirs=folders)
    return assemble([*REGISTRY.plugins, acme])


@pytest.mark.parametrize(
    "wanted",
    [
        "counter-d0500-dispersed-c50-r10",
        "challenge-2020/counter-d0500-dispersed-c50-r10",
        "counter-d0500-dispersed-c50-r1",
        "counter-*0500-d*-c50-r10",
    ],
)
def test_pick(challenge: Expansion, wanted: str) -> None:
    assert pick(challenge, wanted).id == "counter-d0500-dispersed-c50-r10"


@pytest.mark.parametrize("wanted", ["in-", "*", "in-d0125-slow-c01", None])
def test_pick_more_than_one(challenge: Expansion, wanted: str | None) -> None:
    with pytest.raises(InputError, match=r"\d+ scenarios of challenge-2020 match \(in-d0125-slow"):
        pick(challenge, wanted)


def test_pick_unknown_lists_near_ids(challenge: Expansion) -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'in-d0125-slow-c01-r") as caught:
        pick(challenge, "in-d0125-slow-c01-r03")
    assert caught.value.kind == "scenario"


def test_an_exact_id_beats_longer_ones(challenge: Expansion) -> None:
    one = challenge.scenarios[0]
    both = replace(challenge, scenarios=[one, one.model_copy(update={"id": one.id + "-x"})])
    assert pick(both, one.id) is one


def test_pick_without_id_takes_the_only_one(challenge: Expansion) -> None:
    one = replace(challenge, scenarios=challenge.scenarios[:1])
    assert pick(one, None) is challenge.scenarios[0]


def test_pick_ignores_the_suffix_of_overrides() -> None:
    changed = open_spec("challenge-2020", REGISTRY, ["rates.log=8"])
    assert pick(changed, "in-d0125-slow-c01-r02").id.startswith("in-d0125-slow-c01-r02+")


def test_select_keeps_the_order(challenge: Expansion) -> None:
    assert len(select(challenge, "counter-*-c50-*")) == 27


def test_unknown_suite() -> None:
    with pytest.raises(UnknownNameError, match=r"did you mean .*'challenge-2020'"):
        open_spec("challenge-2030", REGISTRY)


@pytest.mark.parametrize("spec", ["nowhere.yaml", "./nowhere"])
def test_missing_file(spec: str) -> None:
    with pytest.raises(SpecError, match=r"E001.*o such file"):
        open_spec(spec, REGISTRY)


class Folder:
    """A folder in something like an archive, whose files may be anything."""

    def __init__(self, names: Iterable[object] = (), *, is_file: bool = False) -> None:
        self._names, self._is_file = names, is_file
        self.name: object = ""

    def is_dir(self) -> bool:
        return not self._is_file

    def iterdir(self) -> Iterator[Folder]:
        for name in self._names:
            if name is SystemExit:
                raise SystemExit(3)
            file = Folder(is_file=True)
            file.name = name
            yield file

    def read_bytes(self) -> bytes:
        return SUITE.encode()


@pytest.mark.parametrize(
    ("names", "why"),
    [
        ([SystemExit], r"SystemExit: 3 \(.*test_library.py:\d+\)"),
        (["../../out.yaml"], "'../../out.yaml' is not the name of a file"),
        ([7], "7 is not the name of a file"),
        (map(str, itertools.count()), "more than 2000 files"),
    ],
)
def test_folders_that_cannot_be_read_are_left_out(
    names: Iterable[object], why: str, caplog: pytest.LogCaptureFixture
) -> None:
    registry = with_plugin(Folder(names))
    assert suite_names(registry) == suite_names(REGISTRY)
    assert len(open_spec("challenge-2020", registry).scenarios) == 162
    assert re.search(f"suites of crowdbot-acme 1.*{why}.*left out", caplog.text)


def test_suite_of_a_plugin(tmp_path: Path) -> None:
    (tmp_path / "office.yaml").write_text(SUITE)
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/minimal.yaml").write_bytes((DATA / "parts/minimal.yaml").read_bytes())
    registry = with_plugin(tmp_path, tmp_path / "missing")
    assert suite_names(registry) == sorted([*suite_names(REGISTRY), "acme:office"])
    assert open_spec("acme:office", registry).suite_id == "office"


def test_suite_inside_an_archive(tmp_path: Path) -> None:
    archive = tmp_path / "wheel.zip"
    with zipfile.ZipFile(archive, "w") as file:
        file.writestr("specs/office.yaml", SUITE)
        file.write(DATA / "parts/minimal.yaml", "specs/parts/minimal.yaml")
    with zipfile.ZipFile(archive) as opened:
        registry = with_plugin(zipfile.Path(opened, "specs/"))
        assert [s.id for s in open_spec("acme:office", registry).scenarios] == ["office"]
