"""Weights: what PyTorch writes is read without it, and nothing in a hostile file is run."""

from __future__ import annotations

import io
import os
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.core.planning.weights.weights_file import npz_bytes, read_weights
from crowdbot.errors import InputError
from tests.core.planning.weights.torch_files import old_file, zip_file, zipped

TABLE = {
    "mlp1.0.weight": np.arange(6, dtype="<f4").reshape(2, 3) / 7.0,
    "mlp1.0.bias": np.array([0.5, -1.0], dtype="<f8"),
    "half": np.array([[1.5]], dtype="<f2"),
    "steps": np.array(7, dtype="<i8"),
}


def _read(folder: Path, content: bytes, name: str = "w.pth") -> dict[str, Any]:
    file = folder / name
    file.write_bytes(content)
    return read_weights(file)


@pytest.mark.parametrize(
    "content",
    [zip_file(TABLE), old_file(TABLE), zip_file(TABLE, around="state_dict")],
    ids=["zip", "old", "checkpoint"],
)
def test_both_formats_of_pytorch(content: bytes, tmp_path: Path) -> None:
    found = _read(tmp_path, content)
    assert list(found) == list(TABLE)
    for name, values in TABLE.items():
        np.testing.assert_array_equal(found[name], values.astype(np.float64))


def test_a_table_by_columns_keeps_its_order(tmp_path: Path) -> None:
    turned = np.asfortranarray(TABLE["mlp1.0.weight"])
    content = zip_file({"w": turned})
    stored = turned.ravel(order="K").tobytes()
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        pickled = archive.read("rl_model/data.pkl")
    np.testing.assert_array_equal(_read(tmp_path, zipped(pickled, {"0": stored}))["w"], turned)


def test_npz_there_and_back_is_equal_and_its_bytes_are_too(tmp_path: Path) -> None:
    single = {n: v.astype(np.float32).astype(np.float64) for n, v in TABLE.items()}
    content = npz_bytes(single)
    found = _read(tmp_path, content, "w.npz")
    for name, values in single.items():
        np.testing.assert_array_equal(found[name], values)
    assert npz_bytes(found) == content


class _Runs:
    """Leaves a file behind when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self) -> Any:
        return os.mkdir, (str(self.trace),)


@pytest.mark.parametrize("protocol", [0, 2, 4])
def test_a_pickle_that_would_run_something_is_refused(protocol: int, tmp_path: Path) -> None:
    trace = tmp_path / "ran"
    evil = pickle.dumps({"w": _Runs(trace)}, protocol=protocol)
    magic = pickle.dumps(0x1950A86A20F9469CFC6C, protocol=2) + pickle.dumps(1001, protocol=2)
    for content in (zipped(evil, {}), magic + evil * 3):
        with pytest.raises(InputError, match=r"mkdir.*state_dict.*nothing of it was run"):
            _read(tmp_path, content)
    assert not trace.exists()


def _memo(index: int) -> bytes:
    """A pickle that makes Python's own reader take memory for this many memo entries."""
    return b"\x80\x02}r" + index.to_bytes(4, "little") + b"."


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"", "neither numpy's"),
        (b"\x93NUMPY", "neither numpy's"),
        (zip_file(TABLE)[:200], "damaged"),
        (old_file(TABLE)[:-9], "numbers of the tensors are missing"),
        (zipped(_memo(2**32 - 1), {}), "not a table of tensors"),
        (zipped(b"\x80\x02.", {}), "damaged"),
        (zipped(b"\x80\x02" + b"(" * 1000, {}), "damaged"),
        (zipped(pickle.dumps({"w": 1}, protocol=2), {}), "'w' is not a tensor"),
        (zipped(pickle.dumps(b"x", protocol=4), {}), "SHORT_BINBYTES"),
    ],
    ids=range(9),
)  # fmt: skip
def test_damaged_and_hostile_files_end_as_one_line(
    content: bytes, expected: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=expected) as caught:
        _read(tmp_path, content)
    assert "\n" not in str(caught.value)


def _tensor(storage: int, offset: int, size: tuple[int, ...], stride: tuple[int, ...]) -> bytes:
    """A table of one tensor with any numbers in its description."""
    from pickle import MARK, STOP, TUPLE

    def number(n: int) -> bytes:
        raw = n.to_bytes(n.bit_length() // 8 + 1, "little", signed=True)
        return b"\x8a" + bytes([len(raw)]) + raw

    def text(t: str) -> bytes:
        return b"X" + len(t).to_bytes(4, "little") + t.encode()

    place = (
        MARK + text("storage") + b"ctorch\nFloatStorage\n" + text("0") + text("cpu")
        + number(storage) + TUPLE + b"Q"
    )  # fmt: skip
    shapes = [MARK + b"".join(map(number, ns)) + TUPLE for ns in (size, stride)]
    made = (
        b"ctorch._utils\n_rebuild_tensor_v2\n" + MARK + place + number(offset) + b"".join(shapes)
        + b"\x89N" + TUPLE + b"R"
    )  # fmt: skip
    return b"\x80\x02}" + text("w") + made + b"s" + STOP


@pytest.mark.parametrize(
    ("storage", "offset", "size", "stride"),
    [
        (4, 0, (5,), (1,)),
        (4, 1, (4,), (1,)),
        (4, -1, (2,), (1,)),
        (4, 0, (2,), (-1,)),
        (4, 0, (2**70,), (0,)),
        (4, 0, (2**20, 2**20), (0, 0)),
        (4, 0, (2,), (2**62,)),
        (4, 0, (2, 2), (1,)),
        (2**40, 0, (2,), (1,)),
        (4, 0, (1,) * 40, (1,) * 40),
        (8, 0, (5,), (1,)),
    ],
)
def test_a_tensor_cannot_leave_its_numbers_or_fill_memory(
    storage: int, offset: int, size: tuple[int, ...], stride: tuple[int, ...], tmp_path: Path
) -> None:
    content = zipped(_tensor(storage, offset, size, stride), {"0": bytes(16)})
    with pytest.raises(InputError):
        _read(tmp_path, content)
    fine = zipped(_tensor(4, 0, (2, 2), (2, 1)), {"0": np.arange(4, dtype="<f4").tobytes()})
    np.testing.assert_array_equal(_read(tmp_path, fine)["w"], [[0.0, 1.0], [2.0, 3.0]])


def test_an_npz_header_cannot_ask_for_memory(tmp_path: Path) -> None:
    header = io.BytesIO()
    about = {"descr": "<f4", "fortran_order": False, "shape": (10**12,)}
    np.lib.format.write_array_header_1_0(header, about)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("w.npy", header.getvalue())
    with pytest.raises(InputError, match="more than"):
        _read(tmp_path, out.getvalue(), "w.npz")


def test_an_npz_with_objects_is_refused(tmp_path: Path) -> None:
    out = io.BytesIO()
    np.savez(out, w=np.array([{}], dtype=object))
    with pytest.raises(InputError, match="not a table of numbers"):
        _read(tmp_path, out.getvalue(), "w.npz")
