"""What a planner or plugin consists of: a change of any file of it is another digest."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, ClassVar

import pytest

from crowdbot.core.support.source_digest import (
    check_source,
    data_files,
    declared_data,
    digest_of_files,
    file_digest,
    imported_names,
    package_files,
    source_digest,
)
from crowdbot.errors import InputError


def write(folder: Path, **files: str) -> None:
    for name, text in files.items():
        file = folder / name.replace("__", "/").replace("_dot_", ".")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


def test_each_file_counts(tmp_path: Path) -> None:
    write(
        tmp_path, mine_dot_py="import helper\nimport importlib\nimportlib.import_module('late')\n",
        helper_dot_py="import deeper\n", deeper_dot_py="", late_dot_py="", other_dot_py="",
        weights_dot_npz="1", more__a_dot_bin="2", more__sub__b_dot_bin="3",
    )  # fmt: skip
    (tmp_path / "native.cpython-311-x86_64-linux-gnu.so").write_bytes(b"0")
    (tmp_path / "deeper.py").write_text("import native\n")

    def digest() -> str:
        return source_digest(tmp_path / "mine.py", ("weights.npz", "more/**/*.bin"))

    seen = {digest()}
    for name in ("mine.py", "helper.py", "deeper.py", "late.py", "weights.npz", "more/a.bin",
                 "more/sub/b.bin"):  # fmt: skip
        (tmp_path / name).write_text((tmp_path / name).read_text() + "\n# changed")
        seen.add(digest())
    assert len(seen) == 8
    (tmp_path / "other.py").write_text("nobody imports it")
    assert digest() in seen


def test_compiled_helpers_count(tmp_path: Path) -> None:
    from importlib.machinery import EXTENSION_SUFFIXES

    write(tmp_path, mine_dot_py="import fast\n")
    (tmp_path / f"fast{EXTENSION_SUFFIXES[0]}").write_bytes(b"0")
    before = source_digest(tmp_path / "mine.py")
    (tmp_path / f"fast{EXTENSION_SUFFIXES[0]}").write_bytes(b"1")
    assert source_digest(tmp_path / "mine.py") != before


def test_names_count_and_order_does_not(tmp_path: Path) -> None:
    write(tmp_path, a="1", b="2")
    a, b = tmp_path / "a", tmp_path / "b"
    assert digest_of_files({"a": a, "b": b}) == digest_of_files({"b": b, "a": a})
    assert digest_of_files({"a": a, "b": b}) != digest_of_files({"a": b, "b": a})


def test_data_anywhere(tmp_path: Path) -> None:
    write(tmp_path, pack__mine_dot_py="", data__a="1", data__b="2", pack__own__c="3")
    folder = tmp_path / "pack"
    assert sorted(data_files(folder, ["../data/*"])) == ["../data/a", "../data/b"]
    assert sorted(data_files(folder, [str(tmp_path / "data")])) == ["../data/a", "../data/b"]
    assert sorted(data_files(folder, ["own", "own/c"])) == ["own/c"]
    for wrong in ("weights.npz", "*.npz", "", "../none/*", "/nowhere/x"):
        with pytest.raises(InputError, match="matches no file"):
            data_files(folder, [wrong])


def test_a_package_and_what_lies_beside_it(tmp_path: Path) -> None:
    write(
        tmp_path, pack__init_dot_py="", pack____init___dot_py="import shared\n",
        pack__weights_dot_bin="1", shared_dot_py="", alone_dot_py="",
    )  # fmt: skip
    (tmp_path / "pack" / "__init__.py").write_text("import shared\nimport pack.init\n")
    (tmp_path / "pack" / "__pycache__").mkdir()
    (tmp_path / "pack" / "__pycache__" / "x.pyc").write_bytes(b"")
    found = set(package_files(tmp_path / "pack"))
    assert {"../shared.py", "weights.bin", "__init__.py"} <= found
    assert not any("alone" in n or "pycache" in n for n in found)


def test_what_is_a_declaration() -> None:
    class One:
        data: ClassVar[Any] = ("a", "b")

    class Field:
        model_fields: ClassVar[Any] = {"data": 1}
        data: ClassVar[Any] = ("a",)

    class Word:
        data: ClassVar[Any] = "a.npz"

    class Number:
        data: ClassVar[Any] = (1, 2)

    assert [declared_data(c) for c in (One, Field, Word, Number, object)] == [
        ("a", "b"), (), ("a.npz",), (), (),
    ]  # fmt: skip


def test_a_source_that_no_parser_takes_imports_nothing(tmp_path: Path) -> None:
    file = tmp_path / "p.py"
    file.write_text("x = " + "-" * 100_000 + "1\n")
    assert imported_names(file) == set()


def test_a_source_has_a_largest_size(tmp_path: Path) -> None:
    file = tmp_path / "p.py"
    file.write_text("x = 1")
    check_source(file)
    with file.open("wb") as opened:
        opened.truncate(20_000_001)
    with pytest.raises(InputError, match="larger than 20 MB; sources are not"):
        check_source(file)


@pytest.mark.parametrize("kind", ["sparse", "pipe", "device"])
def test_a_file_without_an_end_has_no_digest(kind: str, tmp_path: Path) -> None:
    file = tmp_path / "weights.bin"
    if kind == "sparse":
        with file.open("wb") as opened:
            opened.truncate(2 << 40)
    elif kind == "pipe":
        os.mkfifo(file)
    else:
        file.symlink_to("/dev/zero")
    with pytest.raises(
        InputError, match=r"cannot be read: is (larger than 32 GB|a device or pipe)"
    ):
        file_digest(file)
