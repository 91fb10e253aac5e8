"""What a bare machine is told."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from types import ModuleType

import pytest

from tests.paths import ROOT

SCRIPT = ROOT / "scripts" / "check_machine.py"


@pytest.fixture
def machine() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check_machine", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_this_machine_passes() -> None:
    done = subprocess.run(
        [sys.executable, str(SCRIPT)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_it_says_on_what_it_was_tried(machine: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "tried on Linux x86-64 with Python 3.11, 3.12, 3.13" in machine.tried()
    assert "newer" not in machine.tried()
    monkeypatch.setattr(machine.sys, "version_info", (3, 14, 0))
    assert machine.tried().endswith("make PYTHON=python3.13 ...")
    assert machine.problem() == ""


def test_a_missing_library_is_named_in_one_line(
    machine: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine.platform, "system", lambda: "Linux")
    monkeypatch.setattr(machine.platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(machine, "_loads", lambda library: library != "libglib-2.0.so.0")
    assert "apt-get install libglib2.0-0" in machine.problem()
    assert "\n" not in machine.problem()


def test_an_old_python_is_refused(machine: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine.sys, "version_info", (3, 9, 2))
    assert "this is 3.9" in machine.problem()


def test_linux_on_arm_is_refused(machine: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine.platform, "system", lambda: "Linux")
    monkeypatch.setattr(machine.platform, "machine", lambda: "aarch64")
    assert "aarch64" in machine.problem()
