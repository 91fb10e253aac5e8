"""Arrays by address: a table of numbers that shows the arrays of many worlds to compiled code.

Worlds differ in size, and a compiled function takes one list of arrays. So each world has a row of
addresses and shapes, from which compiled code makes arrays at no cost.
"""
# Numba reads the arguments of intrinsics from their definitions.

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numba import types
from numba.extending import intrinsic

from crowdbot.core.types.arrays import Array, Indices, Mask

#: Numbers of an entry: the address of an array, and its size along up to three axes.
ENTRY = 4
_AXES = ENTRY - 1


class ArrayTable:
    """Addresses and shapes of the arrays of one part, by the names of `fields`; keeps them alive.

    Attributes:
        entries: (F, 4) address and sizes of each array, int64.
    """

    def __init__(self, fields: Sequence[str]) -> None:
        self._rows = {name: row for row, name in enumerate(fields)}
        self.entries = np.zeros((len(fields), ENTRY), np.int64)
        self.arrays: dict[str, Any] = {}

    def put(self, **arrays: Any) -> None:
        """Set arrays of float64, int64, bool or records.

        Raises:
            ValueError: an array is not contiguous, or has more than three axes.
        """
        for name, array in arrays.items():
            given = np.asarray(array)
            if not given.flags.c_contiguous or given.ndim > _AXES:
                raise ValueError(f"{name} must be contiguous, with at most {_AXES} axes")
            plain = given.view(np.float64) if given.dtype.names else given
            sizes = (*plain.shape, *[0] * (_AXES - plain.ndim))
            self.entries[self._rows[name]] = (plain.ctypes.data, *sizes)
            self.arrays[name] = array


class ScratchPool:
    """Scratch memory shared by the worlds of a thread, to stay in the processor's cache."""

    def __init__(self) -> None:
        self._kept: dict[tuple[str, tuple[int, ...], str], Any] = {}

    def __call__(self, name: str, like: Any) -> Any:
        """Return the scratch of a name, shape and type; ``like`` if it is the first one."""
        given = np.asarray(like)
        return self._kept.setdefault((name, given.shape, repr(given.dtype)), like)

    def put(self, into: ArrayTable, **arrays: Any) -> None:
        """Set the scratch arrays of a table to shared memory."""
        into.put(**{name: self(name, array) for name, array in arrays.items()})


def _viewer(dtype: Any, axes: int) -> Any:
    """Return an intrinsic that makes an array of entry ``k`` of a table (F, 4)."""
    made_type = types.Array(dtype, axes, "C")

    def view(_: Any, table: Any, k: Any) -> tuple[Any, Any]:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            whole = context.make_array(signature.args[0])(context, builder, values[0])
            k = context.cast(builder, values[1], signature.args[1], types.intp)

            def number(place: int) -> Any:
                at = builder.mul(k, context.get_constant(types.intp, ENTRY))
                at = builder.add(at, context.get_constant(types.intp, place))
                return builder.load(builder.gep(whole.data, [at]))

            item = context.get_data_type(dtype)
            size = context.get_constant(types.intp, context.get_abi_sizeof(item))
            sizes = [number(1 + axis) for axis in range(axes)]
            strides: list[Any] = []
            step = size
            for length in reversed(sizes):
                strides.insert(0, step)
                step = builder.mul(step, length)
            made = context.make_array(made_type)(context, builder)
            made.data = builder.inttoptr(number(0), item.as_pointer())
            made.meminfo, made.parent = made.meminfo.type(None), made.parent.type(None)
            made.itemsize = size
            made.nitems = sizes[0]
            for length in sizes[1:]:
                made.nitems = builder.mul(made.nitems, length)
            tuple_type = types.UniTuple(types.intp, axes)  # type: ignore[no-untyped-call]
            made.shape = context.make_tuple(builder, tuple_type, sizes)
            made.strides = context.make_tuple(builder, tuple_type, strides)
            return made._getvalue()

        return made_type(table, k), generate

    return view


if TYPE_CHECKING:

    def floats1(table: Indices, k: int) -> Array:
        """Return entry k as a float64 array (N,) without copying; the table's owner frees it."""

    def floats2(table: Indices, k: int) -> Array:
        """Like `floats1`, with shape (N, M)."""

    def floats3(table: Indices, k: int) -> Array:
        """Like `floats1`, with shape (N, M, K)."""

    def ints1(table: Indices, k: int) -> Indices:
        """Like `floats1`, of int64."""

    def ints2(table: Indices, k: int) -> Indices:
        """Like `floats2`, of int64."""

    def mask1(table: Indices, k: int) -> Mask:
        """Like `floats1`, of bool."""
else:
    floats1 = intrinsic(_viewer(types.float64, 1))
    floats2 = intrinsic(_viewer(types.float64, 2))
    floats3 = intrinsic(_viewer(types.float64, 3))
    ints1 = intrinsic(_viewer(types.int64, 1))
    ints2 = intrinsic(_viewer(types.int64, 2))
    mask1 = intrinsic(_viewer(types.boolean, 1))
