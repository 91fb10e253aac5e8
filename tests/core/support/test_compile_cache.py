from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from crowdbot.cli.shared import progress as _progress
from crowdbot.cli.shared.progress import show_progress
from crowdbot.core.support.compile_cache import (
    _user_cache,
    kernel_folder,
    use_kernel_cache,
)
from crowdbot.errors import InputError
from tests.waiting import wait_until

pytestmark = pytest.mark.slow

CALLEE = "from numba import njit\n@njit(cache=True)\ndef inner():\n    return {}\n"
CALLER = (
    "import crowdbot.core\n"
    "from numba import njit\n"
    "from callee import inner\n"
    "@njit(cache=True)\ndef outer():\n    return inner()\n"
    "print(outer())\n"
)


def test_a_changed_callee_in_another_file_is_compiled_again(tmp_path: Path) -> None:
    (tmp_path / "caller.py").write_text(CALLER)
    environment = _environment(tmp_path / "kernels")
    answers = []
    for number in (1, 22):
        (tmp_path / "callee.py").write_text(CALLEE.format(number))
        done = subprocess.run(
            [sys.executable, "caller.py"],
            cwd=tmp_path, capture_output=True, text=True, check=True, env=environment,
        )  # fmt: skip
        answers.append(int(done.stdout))
    assert answers == [1, 22]


RENAMED = (
    "import crowdbot.core\n"
    "from typing import NamedTuple\n"
    "import kept\n"
    "class {name}(NamedTuple):\n    x: float\n"
    "kept.{name} = {name}; {name}.__module__ = 'kept'\n"
    "print(kept.outer({name}({value}.0)))\n"
)
KEPT = (
    "from crowdbot.core.support.compiling.compile import kernel\n"
    "@kernel\ndef outer(world):\n    return world.x\n"
)


def test_a_class_that_was_renamed_is_compiled_again(tmp_path: Path) -> None:
    """The index of compiled functions names classes of arguments, which may be gone."""
    (tmp_path / "kept.py").write_text(KEPT)
    answers = []
    for name, value in (("World", 1), ("Other", 22)):
        (tmp_path / "caller.py").write_text(RENAMED.format(name=name, value=value))
        done = subprocess.run(
            [sys.executable, "caller.py"], cwd=tmp_path, capture_output=True, text=True,
            check=True, env=_environment(tmp_path / "kernels"),
        )  # fmt: skip
        answers.append(float(done.stdout))
    assert answers == [1.0, 22.0]


def _environment(kernels: Path) -> dict[str, str]:
    others = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_LOCATOR_CLASSES"}
    return {**others, "NUMBA_CACHE_DIR": str(kernels)}


PLUGIN = """
import sys
sys.path.insert(0, {here!r})
import crowdbot.core
from {name} import outer
print(outer(), sum(outer.stats.cache_hits.values()))
"""


@pytest.mark.parametrize("name", ["package.caller", "package.deep.caller", "lone_caller"])
def test_a_plugins_changed_callee_is_compiled_again(name: str, tmp_path: Path) -> None:
    """And an unchanged one is not."""
    folder = tmp_path.joinpath(*name.split(".")[:-1])
    folder.mkdir(parents=True, exist_ok=True)
    for level in (folder, *folder.parents):
        if level.is_relative_to(tmp_path) and level != tmp_path:
            (level / "__init__.py").touch()
    package = name.rpartition(".")[0].split(".")[0]
    callee = f"{package}.callee" if package else "callee"
    (tmp_path / f"{name.replace('.', '/')}.py").write_text(
        f"from numba import njit\nfrom {callee} import inner\n"
        "@njit('int64()', cache=True)\ndef outer():\n    return inner()\n"
    )
    environment = _environment(tmp_path / "kernels")
    answers = []
    for number in (1, 22, None):
        if number is not None:
            (tmp_path / f"{callee.replace('.', '/')}.py").write_text(CALLEE.format(number))
        done = subprocess.run(
            [sys.executable, "-c", PLUGIN.format(here=str(tmp_path), name=name)],
            capture_output=True, text=True, check=True, env=environment,
        )  # fmt: skip
        answers.append(done.stdout.split())
    assert answers == [["1", "0"], ["22", "0"], ["22", "1"]]


def test_a_read_only_package_uses_the_users_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    _user_cache.cache_clear()
    assert kernel_folder(tmp_path).parent == tmp_path / "cache" / "crowdbot"


def test_no_folder_but_a_temporary_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    _user_cache.cache_clear()
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setenv("HOME", "/proc/nowhere")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/proc/neither")
    use_kernel_cache()
    folder = tmp_path / f"crowdbot-{os.getuid()}" / kernel_folder(tmp_path).name
    assert os.environ["NUMBA_CACHE_DIR"] == str(folder)
    assert folder.parent.stat().st_mode & 0o777 == 0o700  # numba makes the folder in it
    assert "NUMBA_CACHE_DIR: /proc/neither cannot be written" in caplog.text
    assert "NUMBA_CACHE_DIR=FOLDER names another place" in caplog.text
    _user_cache.cache_clear()
    monkeypatch.setattr(tempfile, "tempdir", "/proc")
    with pytest.raises(InputError, match="kept nowhere"):
        kernel_folder(tmp_path)
    _user_cache.cache_clear()


def test_the_first_run_says_that_it_compiles(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))
    with show_progress():
        pass
    assert capsys.readouterr().err == ""  # over at once: a wrong name, say
    monkeypatch.setattr(_progress, "PATIENCE", 0.01)
    with show_progress():
        wait_until(lambda: "the first run compiles" in capsys.readouterr().err)
    compiled = tmp_path / "kernels" / "core_0" / "f.nbi"
    compiled.parent.mkdir(parents=True)
    compiled.touch()
    with show_progress():
        time.sleep(0.1)
    assert capsys.readouterr().err == ""
