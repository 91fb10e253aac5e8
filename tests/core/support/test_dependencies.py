"""Packages that crowdbot needs: versions and licences; lower bounds without known faults."""

from __future__ import annotations

import json
import re
import tomllib

import pytest
from packaging.requirements import Requirement
from packaging.version import Version

from crowdbot import cli
from crowdbot.core.support.dependencies import dependencies
from scripts.write_sbom import document
from tests.paths import ROOT

#: The latest version with a published fault -> its identifier.
FAULTY = {
    "cbor2": ("5.7.1", "CVE-2025-68131"),
    "jinja2": ("3.1.5", "CVE-2025-27516"),
    "cryptography": ("44.0.0", "CVE-2024-12797"),
    "pip": ("25.2", "CVE-2025-8869"),
    "setuptools": ("78.1.0", "CVE-2025-47273"),
}


def _requirements() -> list[Requirement]:
    document = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = document["project"]
    lists = [project["dependencies"], *project["optional-dependencies"].values()]
    return [Requirement(text) for texts in lists for text in texts]


def test_lower_bounds_exclude_known_faults() -> None:
    pinned = (ROOT / "requirements-pip.lock").read_text(encoding="utf-8")
    own = [Requirement(line.partition(" ")[0]) for line in pinned.splitlines() if "==" in line]
    found = {r.name: r for r in [*_requirements(), *own]}
    for name, (version, _) in FAULTY.items():
        assert Version(version) not in found[name].specifier, name


def test_what_is_needed_to_run_is_locked_to_the_versions_that_are_tested() -> None:
    run, everything = (
        set(re.findall(r"^\S+==[^ ]+", (ROOT / lock).read_text("utf-8"), re.MULTILINE))
        for lock in ("requirements-run.lock", "requirements.lock")
    )
    assert run < everything
    names = {line.partition("==")[0] for line in run}
    assert {"drake", "hatchling", "numba"} < names
    assert not {"mypy", "pandas", "pytest"} & names


def test_each_package_has_a_lower_bound() -> None:
    for requirement in _requirements():
        assert any(s.operator in (">=", "==") for s in requirement.specifier), requirement.name


def test_what_is_needed_is_listed_at_any_depth() -> None:
    found = {d.name: d for d in dependencies()}
    assert {"numpy", "jinja2", "markupsafe", "pydantic-core"} <= set(found)
    assert "pytest" not in found or found["pytest"].extra
    assert "markupsafe" in found["jinja2"].needs
    assert not found["numpy"].extra
    stated = [d for d in found.values() if d.licence]
    assert len(stated) > 0.9 * len(found)


def test_the_doctor_lists_licences(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["doctor", "--licences", "--json"]) == 0
    found = {one["name"]: one for one in json.loads(capsys.readouterr().out)}
    assert found["numpy"]["licence"]
    assert cli.main(["doctor", "--licences"]) == 0
    assert "numpy" in capsys.readouterr().out


def test_a_release_says_what_it_consists_of() -> None:
    found = document()
    parts = {c["name"]: c for c in found["components"]}
    assert (found["bomFormat"], parts["numpy"]["scope"]) == ("CycloneDX", "required")
    sums = parts["numpy"]["externalReferences"][0]["hashes"]
    assert len(sums[0]["content"]) == 64
    refs = {c["bom-ref"] for c in found["components"]}
    assert all(set(d["dependsOn"]) <= refs for d in found["dependencies"])
