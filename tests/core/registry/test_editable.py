"""Plugins that are installed to be edited: their version says nothing, so their files do."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.runs import provenance

PLUGIN = """
from typing import ClassVar, Literal
from crowdbot.plugin import Component
from crowdbot.dsl.spec.component_specs import PlannerSpec
from crowdbot.plugin import hookimpl

class Spec(PlannerSpec):
    kind: Literal["{name}.wait"] = "{name}.wait"
    {data}

@hookimpl
def crowdbot_components():
    return {{"planner": [Component(spec=Spec, build="{name}_plug:build", summary="waits")]}}
"""


def install(root: Path, name: str, *, editable: bool, data: str = "") -> Path:
    """A distribution as pip leaves it; the folder of its code."""
    code = root / f"{name}_plug"
    code.mkdir(parents=True)
    (code / "__init__.py").write_text(PLUGIN.format(name=name, data=data))
    about = root / f"{name}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[crowdbot]\n{name} = {name}_plug\n")
    direct = {"url": root.as_uri(), "dir_info": {"editable": editable}}
    (about / "direct_url.json").write_text(json.dumps(direct))
    return code


def entry(name: str) -> dict[str, object]:
    """What a run would record of a plugin, seen anew."""
    found = discover(allow=[name])
    (plugin,) = (p for p in found.plugins if p.name == name)
    assert not plugin.error, plugin.error
    return next(p for p in provenance.plugins(found) if p["name"] == name)


def test_an_editable_plugin_is_not_pinned(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = install(tmp_path, "loose", editable=True)
    install(tmp_path, "firm", editable=False)
    monkeypatch.syspath_prepend(str(tmp_path))
    before = entry("loose")
    assert (before["pinned"], len(str(before["sha256"]))) == (False, 64)
    (code / "helper.py").write_text("x = 1\n")
    assert entry("loose")["sha256"] != before["sha256"]
    assert entry("firm") == {"name": "firm", "distribution": "firm 1.0", "pinned": True}


def test_declared_data_of_an_installed_plugin(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = install(
        tmp_path, "heavy", editable=False, data='data: ClassVar[tuple[str, ...]] = ("*.npz",)'
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    (plugin,) = (p for p in discover(allow=["heavy"]).plugins if p.name == "heavy")
    assert "data '*.npz' matches no file" in plugin.error
    (code / "weights.npz").write_bytes(b"1")
    before = entry("heavy")["data"]
    (code / "weights.npz").write_bytes(b"2")
    assert entry("heavy")["data"] != before


def test_an_interrupt_at_import_is_the_plugins(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Outside of commands Python's own handler is in place; it is there again afterwards."""
    import signal

    code = install(tmp_path, "moody", editable=False)
    (code / "__init__.py").write_text("raise KeyboardInterrupt\n")
    install(tmp_path, "calm", editable=False)
    monkeypatch.syspath_prepend(str(tmp_path))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        found = {p.name: p.error for p in discover(allow=["moody", "calm"]).plugins}
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert "KeyboardInterrupt" in found["moody"]
    assert found["calm"] == ""
