"""The lists that the import rules are written in are complete."""

from __future__ import annotations

import ast
import tomllib
from pathlib import Path

import crowdbot

PACKAGE = Path(crowdbot.__file__).parent
PROJECT = PACKAGE.parent / "pyproject.toml"


def contract(name: str) -> set[str]:
    """Source modules of one import-linter contract."""
    contracts = tomllib.loads(PROJECT.read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    (found,) = (c for c in contracts if c["name"] == name)
    return set(found["source_modules"])


def test_every_part_of_core_but_sim_is_kept_from_drake() -> None:
    parts = {p.stem for p in (PACKAGE / "core").iterdir() if p.suffix == ".py" or p.is_dir()}
    expected = {f"crowdbot.core.{p}" for p in parts - {"__init__", "__pycache__", "sim"}}
    assert contract("only core.sim knows Drake") - {"crowdbot.plugins"} == expected


def test_words_and_deeds_are_apart() -> None:
    """A plugin's word module imports no numbers library; only its ``_build`` twin may."""
    heavy = {"numpy", "numba", "pydrake"}
    for file in (PACKAGE / "plugins").rglob("*.py"):
        if file.stem.endswith("_build"):
            continue
        imported = {
            name.split(".")[0]
            for node in ast.walk(ast.parse(file.read_text("utf-8")))
            for name in (
                [a.name for a in node.names]
                if isinstance(node, ast.Import)
                else [node.module or ""]
                if isinstance(node, ast.ImportFrom)
                else []
            )
        }
        assert not imported & heavy, file


def test_core_never_names_plugins() -> None:
    for file in (PACKAGE / "core").rglob("*.py"):
        assert "crowdbot.plugins" not in file.read_text("utf-8"), file
