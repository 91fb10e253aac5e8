"""Read PyTorch's files of weights, zip archives and the older format, without PyTorch."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from io import BytesIO
from typing import Any
from zlib import error as ZlibError  # noqa: N812 - not one of ours

import numpy as np

from crowdbot.core.planning.weights.table_pickle import TablePickle, TensorStorage, TensorView
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Numbers and largest tables that are read: 512 MB of numbers, 16 MB of table.
MOST_NUMBERS, MOST_TABLE = 1 << 26, 16 << 20
#: First number of a file in the older format, and version of that format.
_MAGIC, _PROTOCOL = 0x1950A86A20F9469CFC6C, 1001
#: Start of a file in the older format: a pickle of its first number.
OLD_START = b"\x80\x02\x8a\x0al\xfc\x9cF\xf9 j\xa8P\x19."
_MOST_AXES = 8
#: Names of the entry that holds the weights, in files that hold more than these.
_INNER = ("state_dict", "model_state_dict", "model")
#: Errors of a zip archive that is damaged.
DAMAGED = (zipfile.BadZipFile, NotImplementedError, EOFError, ZlibError, RuntimeError, OSError)

Numbers = Callable[[TensorStorage], Any]


def read_zip(archive: zipfile.ZipFile, where: str) -> dict[str, Array]:
    """Return name -> weights of a file as PyTorch writes it since version 1.6.

    Raises:
        InputError: it is damaged, too large, or no table of tensors.
    """
    infos = {i.filename: i for i in archive.infolist()}
    tables = [n for n in infos if n.rpartition("/")[2] == "data.pkl"]
    if len(tables) != 1 or len(infos) < len(archive.infolist()):
        raise InputError(f"{where}: it has not one table data.pkl, as PyTorch's files have")
    folder = tables[0].removesuffix("data.pkl")
    order = f"{folder}byteorder"
    big = order in infos and _member(archive, order, 16, where).strip() == b"big"
    prefix = ">" if big else "<"
    table = TablePickle(BytesIO(_member(archive, tables[0], MOST_TABLE, where)), where).read()

    def numbers(storage: TensorStorage) -> Any:
        name, size = f"{folder}data/{storage.key}", storage.numbers * _width(storage.dtype)
        return _numbers(_member(archive, name, size, where), storage, prefix, where)

    return _weights(table, numbers, where)


def read_old(content: bytes, where: str) -> dict[str, Array]:
    """Return name -> weights of a file as PyTorch wrote it before version 1.6.

    Raises:
        InputError: as `read_zip`.
    """
    stream = BytesIO(content)
    pickles = TablePickle(stream, where)
    if (pickles.read(), pickles.read()) != (_MAGIC, _PROTOCOL):
        raise InputError(f"{where}: it has not the first numbers of PyTorch's files")
    machine, table, keys = pickles.read(), pickles.read(), pickles.read()
    little = machine.get("little_endian") if isinstance(machine, dict) else None
    if not isinstance(little, bool) or not isinstance(keys, list):
        raise InputError(f"{where}: its tables are damaged")
    prefix = "<" if little else ">"
    kinds = {s.key: s for s in _storages(table)}
    found: dict[str, Any] = {}
    for key in keys:
        if not isinstance(key, str) or key not in kinds:
            raise InputError(f"{where}: it holds numbers that no tensor has")
        count, storage = int.from_bytes(stream.read(8), "little" if little else "big"), kinds[key]
        if count != storage.numbers:
            raise InputError(f"{where}: numbers of the tensors are missing")
        found[key] = _numbers(stream.read(count * _width(storage.dtype)), storage, prefix, where)
    if missing := set(kinds) - set(found):
        raise InputError(f"{where}: numbers of the tensors are missing: {len(missing)} storages")
    return _weights(table, lambda s: found[s.key], where)


def _member(archive: zipfile.ZipFile, name: str, most: int, where: str) -> bytes:
    try:
        with archive.open(name) as file:
            content = file.read(most + 1)
    except KeyError:
        raise InputError(f"{where}: numbers of the tensors are missing") from None
    except DAMAGED as error:
        raise InputError(f"{where}: it is damaged: {error}") from None
    if len(content) > most:
        raise InputError(f"{where}: a part of it is larger than {most} bytes")
    return content


def _width(dtype: str) -> int:
    return 1 if dtype == "?" else int(dtype[-1])


def _numbers(content: bytes, storage: TensorStorage, prefix: str, where: str) -> Any:
    if len(content) != storage.numbers * _width(storage.dtype):
        raise InputError(f"{where}: numbers of the tensors are missing")
    if storage.dtype == "bf2":  # the upper half of a single float
        upper = np.frombuffer(content, f"{prefix}u2").astype(np.uint32)
        return (upper << np.uint32(16)).view(np.float32)
    dtype = storage.dtype if _width(storage.dtype) == 1 else prefix + storage.dtype
    return np.frombuffer(content, dtype)


def _table_of(table: Any, where: str) -> dict[str, TensorView]:
    """Return the entries of a table, or of the part of it that holds the weights."""
    entries = table if isinstance(table, dict) else {}
    inner = next((entries[n] for n in _INNER if isinstance(entries.get(n), dict)), None)
    found = inner or table
    if not isinstance(found, dict) or not found:
        raise InputError(f"{where}: it is not a table of tensors")
    for name, value in found.items():
        if not isinstance(name, str) or not isinstance(value, TensorView):
            raise InputError(f"{where}: its entry {str(name)[:60]!a} is not a tensor")
    return found


def _storages(table: Any) -> set[TensorStorage]:
    entries = list(table.values()) if isinstance(table, dict) else []
    entries += [e for entry in entries if isinstance(entry, dict) for e in entry.values()]
    return {e.storage for e in entries if isinstance(e, TensorView)}


def _weights(table: Any, numbers: Numbers, where: str) -> dict[str, Array]:
    views = _table_of(table, where)
    total = 0
    for name, view in views.items():
        total += _checked(view, f"{where}: {name[:60]!a}")
        if total > MOST_NUMBERS or view.storage.numbers > MOST_NUMBERS:
            raise InputError(f"{where}: more than {MOST_NUMBERS} numbers")
    weights = {}
    for name, view in views.items():
        flat = numbers(view.storage)
        shown_once = zip(view.stride, view.size, strict=True)
        strides = [s * flat.itemsize if n > 1 else 0 for s, n in shown_once]
        shown = np.lib.stride_tricks.as_strided(flat[view.offset :], view.size, strides)
        weights[name] = np.array(shown, dtype=np.float64, order="C")
    return weights


def _checked(view: TensorView, where: str) -> int:
    """Return how many numbers a tensor has; raise if it leaves its storage."""
    size, stride = view.size, view.stride
    fits = len(size) == len(stride) <= _MOST_AXES and max((0, *size)) <= MOST_NUMBERS
    if not fits or min((0, *size, *stride)) < 0:
        raise InputError(f"{where} has an impossible shape")
    count = 1
    for n in size:
        count *= n
    last = view.offset + sum((n - 1) * s for n, s in zip(size, stride, strict=True))
    if view.offset < 0 or (count and last >= view.storage.numbers):
        raise InputError(f"{where} is larger than its numbers")
    return count
