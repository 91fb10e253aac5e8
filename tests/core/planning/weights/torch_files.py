"""Files as PyTorch writes them, made without PyTorch, and hostile ones."""

from __future__ import annotations

import io
import pickle
import sys
import zipfile
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Table = Mapping[str, NDArray[Any]]
_STORAGES = {"f4": "FloatStorage", "f8": "DoubleStorage", "f2": "HalfStorage", "i8": "LongStorage"}


class _Storage:
    """Numbers of one tensor; pickled as a persistent id."""

    def __init__(self, key: str, values: NDArray[Any]) -> None:
        self.key, self.values = key, values


class _Tensor:
    """Is pickled as PyTorch pickles its tensors."""

    def __init__(self, storage: _Storage) -> None:
        self.storage = storage

    def __reduce__(self) -> Any:
        values = self.storage.values
        strides = tuple(s // values.itemsize for s in values.strides)
        rebuild = sys.modules["torch._utils"]._rebuild_tensor_v2
        return rebuild, (self.storage, 0, values.shape, strides, False, OrderedDict())


class _Pickler(pickle.Pickler):
    def persistent_id(self, obj: Any) -> Any:
        if not isinstance(obj, _Storage):
            return None
        kind = getattr(sys.modules["torch"], _STORAGES[obj.values.dtype.str[1:]])
        return "storage", kind, obj.key, "cpu", obj.values.size


@contextmanager
def _torch() -> Iterator[None]:
    """Stand-ins for the modules whose names are pickled."""
    torch, utils = ModuleType("torch"), ModuleType("torch._utils")
    for name in _STORAGES.values():
        setattr(torch, name, type(name, (), {"__module__": "torch"}))

    def _rebuild_tensor_v2() -> None: ...

    _rebuild_tensor_v2.__module__ = utils.__name__
    _rebuild_tensor_v2.__qualname__ = "_rebuild_tensor_v2"
    utils._rebuild_tensor_v2 = _rebuild_tensor_v2  # type: ignore[attr-defined]
    names = {"torch": torch, "torch._utils": utils}
    before = {n: sys.modules.get(n) for n in names}
    sys.modules.update(names)
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def _pickled(obj: Any) -> bytes:
    out = io.BytesIO()
    _Pickler(out, protocol=2).dump(obj)
    return out.getvalue()


def _state(table: Table) -> tuple[OrderedDict[str, Any], list[_Storage]]:
    storages = [_Storage(str(n), v) for n, v in enumerate(table.values())]
    state: OrderedDict[str, Any] = OrderedDict(zip(table, map(_Tensor, storages), strict=True))
    state._metadata = OrderedDict({"": {"version": 1}})  # type: ignore[attr-defined]
    return state, storages


def zip_file(table: Table, *, around: str = "") -> bytes:
    """Return a file in the format of PyTorch 1.6 and later.

    Args:
        around: name of an entry that holds the table beside others; empty: the table alone.
    """
    with _torch():
        state, storages = _state(table)
        pickled = _pickled({"epoch": 3, around: state} if around else state)
    return zipped(pickled, {s.key: np.ascontiguousarray(s.values).tobytes() for s in storages})


def zipped(pickled: bytes, storages: Mapping[str, bytes]) -> bytes:
    """Return the archive around a pickle and its numbers."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("rl_model/data.pkl", pickled)
        archive.writestr("rl_model/byteorder", b"little")
        for key, content in storages.items():
            archive.writestr(f"rl_model/data/{key}", content)
        archive.writestr("rl_model/version", b"3\n")
    return out.getvalue()


def old_file(table: Table) -> bytes:
    """Return a file in the format before PyTorch 1.6."""
    with _torch():
        state, storages = _state(table)
        parts = [
            pickle.dumps(0x1950A86A20F9469CFC6C, protocol=2),
            pickle.dumps(1001, protocol=2),
            pickle.dumps({"protocol_version": 1001, "little_endian": True}, protocol=2),
            _pickled(state),
            pickle.dumps([s.key for s in storages], protocol=2),
        ]
    for storage in storages:
        parts += [storage.values.size.to_bytes(8, "little"), storage.values.tobytes()]
    return b"".join(parts)
