"""Files of weights: numpy's ``.npz`` and PyTorch's ``.pth``."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np

from crowdbot.core.planning.weights.torch_file import (
    DAMAGED,
    MOST_NUMBERS,
    OLD_START,
    read_old,
    read_zip,
)
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.text.bounded_files import read_bytes, reason_of
from crowdbot.errors import InputError

#: Largest file, bytes.
_LARGEST = 1 << 30
_ARRAY = ".npy"


def read_weights(path: Path | str) -> dict[str, Array]:
    """Return name -> weights of a file, in the order of the file; nothing in it is run.

    Args:
        path: numpy's ``.npz``, or what PyTorch's ``save`` made of a ``state_dict``.

    Raises:
        InputError: it cannot be read, is damaged, too large, or something else.
    """
    where = str(path)
    try:
        content = read_bytes(Path(path), _LARGEST)
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: cannot be read: {reason_of(error)}") from None
    if content.startswith(OLD_START):
        return read_old(content, where)
    if not content.startswith(b"PK"):
        raise InputError(
            f"{where}: neither numpy's .npz nor a file of PyTorch (torch.save(model.state_dict()))"
        )
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            names = archive.namelist()
            if names and all(n.endswith(_ARRAY) for n in names):
                return _read_npz(archive, where)
            return read_zip(archive, where)
    except (*DAMAGED, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{where}: it is damaged: {error}") from None


def npz_bytes(weights: Mapping[str, Array]) -> bytes:
    """Return the content of an ``.npz`` file in single precision; equal weights, equal bytes."""
    out = BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
        for name, values in weights.items():
            array = BytesIO()
            np.lib.format.write_array(array, np.asarray(values, dtype="<f4"), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}{_ARRAY}"), array.getvalue())
    return out.getvalue()


def _read_npz(archive: zipfile.ZipFile, where: str) -> dict[str, Array]:
    found: dict[str, Array] = {}
    total = 0
    for info in archive.infolist():
        name = info.filename.removesuffix(_ARRAY)
        with archive.open(info) as file:
            version = np.lib.format.read_magic(file)
            header = (
                np.lib.format.read_array_header_1_0
                if version == (1, 0)
                else np.lib.format.read_array_header_2_0
            )
            shape, by_columns, dtype = header(file)
            count = 1
            for n in shape:
                count *= n
            total += count
            if dtype.kind not in "fiub" or name in found or min((0, *shape)) < 0:
                raise InputError(f"{where}: its entry {name[:60]!a} is not a table of numbers")
            if total > MOST_NUMBERS:
                raise InputError(f"{where}: more than {MOST_NUMBERS} numbers")
            content = file.read(count * dtype.itemsize)
            if len(content) != count * dtype.itemsize or file.read(1):
                raise InputError(f"{where}: its entry {name[:60]!a} is damaged")
        flat = np.frombuffer(content, dtype)
        found[name] = flat.reshape(shape, order="F" if by_columns else "C").astype(np.float64, "C")
    return found
