"""Documents made to hurt: a clear error or the right reading, with bounded work and memory."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import TypeVar

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import installed
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.text.diagnostics import MAX_ERRORS, Diagnostic, render
from crowdbot.errors import SpecError, hidden_character
from tests.paths import DATA

pytestmark = pytest.mark.slow

T = TypeVar("T")

REGISTRY = discover(allow=())
PARTS = DATA / "diagnostics" / "parts"
HEAD = "crowdbot: 1\nsuite: {id: s}\nbase:\n  extends: minimal.yaml\n"
AXES = "matrix: {" + ", ".join(
    f"{a}: {{{', '.join(f'{a}{i}: {{}}' for i in range(10))}}}" for a in "wxyz"
) + "}\n"  # fmt: skip


def many(count: int, line: str) -> str:
    return "".join(line.format(i) for i in range(count))


#: Text, code of the first error (nothing: valid), limit of calls in thousands: twice what it takes.
CASES = {
    "bomb": ("a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]\n", "E004", 10),
    "anchors": (HEAD + "x: [" + many(40_000, "&a{} 1, ") + "]", "E004", 25000),
    "deep flow": (HEAD + "x: " + "[" * 400_000, "E009", 8000),
    "deep maps": (HEAD + "x: " + "{a: " * 200_000, "E009", 50),
    "deep block": ("".join(f"{' ' * i}a:\n" for i in range(900)), "E009", 50),
    "dashes": ("- " * 400_000, "E009", 20),
    "dotted": (HEAD + "  " + ".".join("a" * 60) + ": 1\n", "E009", 200),
    "keys": (HEAD + many(10_000, "  k{}: 1\n"), "E102", 10000),
    "dotted keys": (HEAD + many(10_000, "  crowd.k{}: 1\n"), "E204", 10000),
    "duplicates": (HEAD + many(10_000, "  a: {}\n"), "E102", 10000),
    "axes": (HEAD + "matrix:\n" + many(10_000, "  a{}: {{x: {{}}}}\n"), "E207", 20000),
    "choices": (HEAD + AXES + "exclude: [" + many(9_000, "{{w: w1}},") + "]", "E207", 15000),
    "references": (HEAD + "references:\n" + many(3000, "  r{}: {{crowd: null}}\n"), "E207", 6000),
    "work": (HEAD + many(2000, "  crowd.costs.c{}: {{kind: rvo}}\n") + AXES, "E207", 5000),
    "draws": (HEAD + "draws: 1" + "0" * 39, "E112", 200),
    "huge scalar": (HEAD + "  title: " + "x" * 900_000, "", 6000),
    "huge key": (HEAD + "  " + "k" * 900_000 + ": 1", "E002", 6000),
    "1e999": (HEAD + "  crowd.speed.mean: 1e999", "E008", 200),
    "400 digits": (HEAD + "  crowd.speed.mean: 1" + "0" * 400, "E008", 200),
    "digits": (HEAD + "  crowd.speed.mean: '" + "9" * 900_000 + " m/s'", "E110", 2500),
    "exponent": (HEAD + "  crowd.speed.mean: '1e" + "9" * 300_000 + " m/s'", "E110", 1000),
    "pattern": (HEAD + "metrics: ['" + "*a" * 2000 + "b']", "E121", 500),
    "crlf": (HEAD.replace("\n", "\r\n"), "", 200),
    "bom": ("\ufeff" + HEAD, "", 200),
    "nul": (HEAD + "\0", "E001", 10),
}  # fmt: skip


def counted(call: Callable[[], T]) -> tuple[T, int]:
    """What a function returns, and how many calls of Python functions that took.

    A busy machine makes them take longer, but not more.
    """
    calls = 0

    def count(_: FrameType, event: str, __: object) -> None:
        nonlocal calls
        calls += event == "call"

    sys.setprofile(count)
    try:
        return call(), calls
    finally:
        sys.setprofile(None)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "minimal.yaml").write_bytes((PARTS / "minimal.yaml").read_bytes())
    return tmp_path / "d.yaml"


@pytest.mark.parametrize("name", CASES)
def test_document(name: str, file: Path) -> None:
    text, code, limit = CASES[name]
    file.write_text(text, encoding="utf-8", newline="")
    found, calls = counted(lambda: codes(file))
    assert found[:1] == ([code] if code else [])
    assert calls < 1000 * limit


def codes(file: Path) -> list[str]:
    found = errors(file)
    assert len(found) <= MAX_ERRORS
    assert all(len(line) < 1000 for line in render(found).split("\n"))
    return [d.code for d in found]


def errors(file: Path) -> tuple[Diagnostic, ...]:
    try:
        suite = load_document(file, installed=installed(REGISTRY))
        expand_document(suite, REGISTRY.scenario_model)
    except SpecError as error:
        return error.diagnostics
    return ()


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "loop", "large"])
def test_what_is_no_file(kind: str, file: Path) -> None:
    target = file.with_name("part.yaml")
    if kind == "pipe":
        os.mkfifo(target)
    elif kind == "device":
        target.symlink_to("/dev/zero")
    elif kind == "folder":
        target.mkdir()
    elif kind == "loop":
        target.symlink_to(target)
    else:
        with target.open("wb") as large:
            large.truncate(100_000_000)
    assert codes(target) == ["E001"]
    file.write_text(HEAD.replace("minimal.yaml", "part.yaml"))
    assert set(codes(file)) <= {"E001", "E201", "E203"}
    assert codes(file)


@pytest.mark.parametrize("path", ["../x.yaml", "/etc/passwd", "link.yaml", "a/../../x.yaml"])
def test_nothing_outside_is_read(path: str, file: Path) -> None:
    folder = file.parent / "inside"
    folder.mkdir()
    (file.parent / "x.yaml").write_text("secret: 1\n")
    (folder / "link.yaml").symlink_to(file.parent / "x.yaml")
    (folder / "d.yaml").write_text(HEAD.replace("minimal.yaml", path))
    assert codes(folder / "d.yaml") == ["E203"]


@pytest.mark.skipif(sys.platform != "linux", reason="reads its memory from /proc")
def test_memory_stays_bounded(file: Path) -> None:
    """The largest document, in a process that may have 700 MB."""
    file.write_text(HEAD + AXES + "  # \n" * 1000)
    code = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_AS, (700 << 20, 700 << 20)); "
        "from crowdbot.cli import main; code = main(['expand', sys.argv[1], '--count']); "
        "status = open('/proc/self/status').read(); "  # maxrss would be that of our process
        "print(status.partition('VmHWM:')[2].split()[0], file=sys.stderr); "
        "sys.exit(code)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(file)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (0, "10000\n"), done.stderr
    assert int(done.stderr) < 500 * 1024  # kB


@pytest.mark.parametrize(
    "argv",
    [
        ["validate", "challenge-2020"],
        ["expand", "challenge-2020"],
        ["lock", "challenge-2020", "--check"],
    ],
)
def test_no_heavy_imports(argv: list[str]) -> None:
    code = (
        "import sys; from crowdbot.cli import main; code = main(sys.argv[1:]); "
        "print([m for m in ('numpy', 'numba', 'pydrake') if m in sys.modules], file=sys.stderr); "
        "sys.exit(code)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *argv], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "[]\n")


@pytest.mark.parametrize(
    ("text", "line", "carets"),
    [
        (HEAD.replace("id: s", "id: 's\u202egnp'"),
         "    2 | suite: {id: 's\\u202egnp'}", " " * 13 + "^" * 12),
        (HEAD.replace("minimal.yaml", '"a\\0b\\ny"'),
         '    4 |   extends: "a\\0b\\ny"', " " * 12 + "^" * 8),
        (HEAD + "\ufeff  x: 1\n", "    5 | \\ufeff  x: 1", " " + "^" * 8),
    ],
)  # fmt: skip
def test_a_terminal_gets_no_hidden_characters(
    text: str, line: str, carets: str, file: Path
) -> None:
    file.write_text(text, encoding="utf-8")
    found = errors(file)
    shown = render(found)
    assert not hidden_character(shown, allowed="\n")
    assert shown.split("\n")[0] == found[0].headline()
    lines = shown.split("\n")
    assert lines[1] == line
    assert lines[2].startswith(f"      |{carets}")
