"""Documents made to hurt: a clear error or the right reading, in bounded time and memory."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from crowdbot.core.library import installed
from crowdbot.core.registry import discover
from crowdbot.dsl.diagnostics import MAX_ERRORS, Diagnostic, render
from crowdbot.dsl.expand import expand_document, load_document
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
PARTS = Path(__file__).parent.parent / "data" / "diagnostics" / "parts"
HEAD = "crowdbot: 1\nsuite: {id: s}\nbase:\n  extends: minimal.yaml\n"
AXES = "matrix: {" + ", ".join(
    f"{a}: {{{', '.join(f'{a}{i}: {{}}' for i in range(10))}}}" for a in "wxyz"
) + "}\n"  # fmt: skip


def many(count: int, line: str) -> str:
    return "".join(line.format(i) for i in range(count))


#: Text, code of the first error (nothing: valid), limit in CPU seconds.
CASES = {
    "bomb": ("a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]\n", "E004", 1),
    "anchors": (HEAD + "x: [" + many(40_000, "&a{} 1, ") + "]", "E004", 15),
    "deep flow": (HEAD + "x: " + "[" * 400_000, "E009", 2),
    "deep maps": (HEAD + "x: " + "{a: " * 200_000, "E009", 2),
    "deep block": ("".join(f"{' ' * i}a:\n" for i in range(900)), "E009", 2),
    "dashes": ("- " * 400_000, "E009", 2),
    "dotted": (HEAD + "  " + ".".join("a" * 60) + ": 1\n", "E009", 1),
    "keys": (HEAD + many(10_000, "  k{}: 1\n"), "E102", 15),
    "dotted keys": (HEAD + many(10_000, "  crowd.k{}: 1\n"), "E204", 15),
    "duplicates": (HEAD + many(10_000, "  a: {}\n"), "E102", 15),
    "axes": (HEAD + "matrix:\n" + many(10_000, "  a{}: {{x: {{}}}}\n"), "E207", 10),
    "choices": (HEAD + AXES + "exclude: [" + many(9_000, "{{w: w1}},") + "]", "E207", 15),
    "references": (HEAD + "references:\n" + many(3000, "  r{}: {{crowd: null}}\n"), "E207", 10),
    "work": (HEAD + many(2000, "  crowd.costs.c{}: {{kind: rvo}}\n") + AXES, "E207", 10),
    "replicates": (HEAD + "replicates: 1" + "0" * 39, "E112", 1),
    "huge scalar": (HEAD + "  title: " + "x" * 900_000, "", 5),
    "huge key": (HEAD + "  " + "k" * 900_000 + ": 1", "E002", 5),
    "1e999": (HEAD + "  crowd.speed.mean: 1e999", "E008", 1),
    "400 digits": (HEAD + "  crowd.speed.mean: 1" + "0" * 400, "E008", 1),
    "digits": (HEAD + "  crowd.speed.mean: '" + "9" * 900_000 + " m/s'", "E110", 5),
    "exponent": (HEAD + "  crowd.speed.mean: '1e" + "9" * 300_000 + " m/s'", "E110", 5),
    "pattern": (HEAD + "metrics: ['" + "*a" * 2000 + "b']", "E121", 2),
    "crlf": (HEAD.replace("\n", "\r\n"), "", 1),
    "bom": ("\ufeff" + HEAD, "", 1),
    "nul": (HEAD + "\0", "E001", 1),
}  # fmt: skip


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "minimal.yaml").write_bytes((PARTS / "minimal.yaml").read_bytes())
    return tmp_path / "d.yaml"


@pytest.mark.parametrize("name", CASES)
def test_document(name: str, file: Path) -> None:
    text, code, limit = CASES[name]
    file.write_text(text, encoding="utf-8", newline="")
    start = time.process_time()
    first = codes(file)[:1]
    assert time.process_time() - start < limit
    assert first == ([code] if code else [])


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
