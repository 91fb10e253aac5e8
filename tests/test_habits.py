"""What a change has to bring along: hooks that exist, fragments of the changelog."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from ruamel.yaml import YAML

from tests.paths import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_hooks_call_what_make_check_calls() -> None:
    """In the same versions: those of the environment that the lock makes."""
    hooks = YAML(typ="safe").load(ROOT / ".pre-commit-config.yaml")["repos"][0]["hooks"]
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8").replace("$(BIN)", ".venv/bin")
    for hook in hooks:
        program, *words = hook["entry"].split()
        assert Path(sys.executable).with_name(Path(program).name).exists(), hook["id"]
        assert " ".join([program, *(w for w in words if not w.startswith("-"))]) in makefile


def test_each_change_is_a_file_of_one_paragraph() -> None:
    kinds = {kind["directory"] for kind in PROJECT["tool"]["towncrier"]["type"]}
    fragments = sorted((ROOT / PROJECT["tool"]["towncrier"]["directory"]).glob("*"))
    for fragment in fragments:
        if fragment.name == "README.md":
            continue
        match = re.fullmatch(r"\+[a-z0-9-]+\.([a-z]+)\.md", fragment.name)
        assert match, f"{fragment.name}: see changelog.d/README.md"
        assert match[1] in kinds, fragment.name
        text = fragment.read_text(encoding="utf-8")
        assert text.endswith(".\n"), fragment.name
        assert text.count("\n") == 1, fragment.name


def test_the_fragments_become_an_entry_of_the_changelog() -> None:
    towncrier = str(Path(sys.executable).with_name("towncrier"))
    done = subprocess.run(
        [towncrier, "build", "--draft", "--version", "9.9.9", "--config", "pyproject.toml"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    folder = ROOT / PROJECT["tool"]["towncrier"]["directory"]
    for fragment in folder.glob("+*.md"):
        assert f"- {fragment.read_text(encoding='utf-8').strip()}" in done.stdout, fragment.name


def test_the_changelog_has_the_place_where_releases_go() -> None:
    mark = PROJECT["tool"]["towncrier"]["start_string"]
    assert (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").count(mark) == 1


#: What lies at the top of the repository; files that were tried out do not.
TOP = {
    ".ci", ".gitignore", ".pre-commit-config.yaml", "CHANGELOG.md", "CITATION.cff",
    "CONTRIBUTING.md", "Containerfile", "LICENSE", "Makefile", "README.md", "benchmarks",
    "changelog.d", "crowdbot", "docs", "hatch_build.py", "pyproject.toml", "requirements-pip.lock",
    "requirements-run.lock", "requirements.lock", "scenario_specs", "scripts", "tests",
}  # fmt: skip


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="not a clone")
def test_nothing_else_lies_at_the_top() -> None:
    command = ["git", "ls-files", "-z"]
    names = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    assert {name.partition("/")[0] for name in names.split("\0") if name} == TOP
