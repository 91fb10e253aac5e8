"""Named columns in compiled code: records whose fields are all float64.

A record is declared as a class, whose annotations name its fields in order, and `record_type` makes
the numpy dtype that compiled code knows it by. Records lie on plain float64 memory: `as_record`
and `as_rows` give names to what a pointer or an array holds, free of charge. The type checker sees
the class, so it finds a wrong name.

A compiled function takes records of one type at each place, always the same: numba numbers types
again in every process, and symbols of compiled functions contain these numbers.
"""

from __future__ import annotations

import inspect
import operator
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar, cast, overload

import numpy as np
from numba import types
from numba.core import errors
from numba.core.datamodel import models
from numba.core.datamodel.registry import register_default
from numba.extending import intrinsic, lower_builtin
from numba.np.numpy_support import from_dtype
from numpy.typing import NDArray

T = TypeVar("T")
#: Length of the rows behind a pointer; numba wants one, and does not check it.
_ANY = 1


class RecordType(Generic[T]):
    """The result of `record_type` for the type checker; at run time it is a numpy dtype."""

    itemsize: int
    names: tuple[str, ...]


class Rows(Protocol[T]):
    """Records one after another: a numpy array of a record's dtype."""

    @property
    def shape(self) -> tuple[int]:
        """Return the number of records, like that of an array with one dimension."""

    @overload
    def __getitem__(self, row: int) -> T: ...
    @overload
    def __getitem__(self, row: slice) -> Rows[T]: ...
    @overload
    def __getitem__(self, row: str) -> NDArray[np.float64]: ...

    def __setitem__(self, row: int, record: T) -> None:
        """Copy a record."""


def rows_of(count: int, record: RecordType[T]) -> Rows[T]:
    """Return a number of new records of zeros."""
    return cast(Rows[T], np.zeros(count, cast(Any, record)))


def rows_in(numbers: NDArray[np.float64], record: RecordType[T]) -> Rows[T]:
    """Return the records in a contiguous array, sharing its memory; `as_rows` for Python code.

    Raises:
        ValueError: the array is not contiguous, or does not hold whole records.
    """
    dtype: Any = record
    # Half the time of a view; an unquoted type would be built at each call.
    return cast("Rows[T]", np.frombuffer(numbers, dtype))


def numbers_of(*arguments: Any) -> tuple[Any, ...]:
    """Return arguments with records replaced by plain float64 arrays, sharing their memory.

    Numba takes plain arrays from Python 0.1 us faster.
    """
    return tuple(
        a.view(np.float64) if isinstance(a, np.ndarray) and a.dtype.names else a for a in arguments
    )


def record_type(declared: type[T], columns: int | None = None) -> RecordType[T]:
    """Return the dtype of a record with the annotated fields of a class and its bases.

    Args:
        columns: width of a row in float64 values, if it is larger than the number of fields.
    """
    names = fields_of(declared)
    width = len(names) if columns is None else columns
    if len(names) > width:
        raise TypeError(f"{declared.__name__} has {len(names)} fields, but room for {width}")
    layout: Any = {
        "names": names,
        "formats": [np.float64] * len(names),
        "offsets": [8 * k for k in range(len(names))],
        "itemsize": 8 * width,
    }
    return cast(RecordType[T], np.dtype(layout, align=True))


def fields_of(declared: type) -> list[str]:
    """Return the names of a record's fields, in order."""
    bases = reversed(declared.__mro__)
    return [name for base in bases for name in inspect.get_annotations(base)]


def columns_of(record: RecordType[Any]) -> int:
    """Return the number of float64 values in a record."""
    return record.itemsize // 8


def record_values(
    record: RecordType[Any], source: object = None, /, **values: float
) -> NDArray[np.float64]:
    """Return the values of a record's fields as an array, in the fields' order.

    Args:
        record: the type.
        source: its attributes are the values of fields that are not given.
        values: by field.

    Raises:
        TypeError: a value is missing, or there is no such field.
    """
    others = (n for n in record.names if n not in values and hasattr(source, n))
    values |= {name: getattr(source, name) for name in others}
    wrong = set(record.names) ^ values.keys()
    if wrong:
        raise TypeError(f"missing or unknown fields: {', '.join(sorted(wrong))}")
    return np.array([values[name] for name in record.names], np.float64)


class RecordPointer(types.CPointer):
    """A pointer to records, which can be indexed."""

    @property
    def mangling_args(self) -> tuple[str, tuple[Any, ...]]:
        """Return the type's name in symbols; numba's own would spell out all fields."""
        return type(self).__name__, (self.dtype,)


register_default(RecordPointer)(models.PointerModel)


@lower_builtin(operator.getitem, RecordPointer, types.Integer)  # type: ignore[untyped-decorator, no-untyped-call]
def _row(_: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
    return builder.gep(values[0], [values[1]])


def record_argument(record: RecordType[Any]) -> Any:
    """Return numba's type of a record."""
    return from_dtype(cast(Any, record))


def rows_argument(record: RecordType[Any]) -> Any:
    """Return numba's type of a pointer to records."""
    return RecordPointer(record_argument(record))  # type: ignore[no-untyped-call]


def start_of(context: Any, builder: Any, source: Any, value: Any) -> Any:
    """Return the LLVM pointer to the memory of a pointer, an array or a record."""
    if isinstance(source, types.Array):
        return context.make_array(source)(context, builder, value).data
    return value


def _as_record(_: Any, source: Any, record: Any) -> tuple[Any, Any]:
    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        start = start_of(context, builder, signature.args[0], values[0])
        return builder.bitcast(start, context.get_value_type(record.dtype))

    return record.dtype(source, record), generate


def _as_rows(_: Any, source: Any, record: Any) -> tuple[Any, Any]:
    if isinstance(source, types.Array) and source.layout != "C":
        raise errors.TypingError("records lie in contiguous arrays")
    rows = types.Array(record.dtype, 1, "C")

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        size = context.get_constant(types.intp, record.dtype.size)
        count = context.get_constant(types.intp, _ANY)
        if isinstance(source, types.Array):
            given = context.make_array(source)(context, builder, values[0])
            count = builder.udiv(builder.mul(given.nitems, given.itemsize), size)
        made = context.make_array(rows)(context, builder)
        start = start_of(context, builder, signature.args[0], values[0])
        made.data = builder.bitcast(start, context.get_value_type(record.dtype))
        made.meminfo, made.parent = made.meminfo.type(None), made.parent.type(None)
        made.nitems, made.itemsize = count, size
        one = types.UniTuple(types.intp, 1)  # type: ignore[no-untyped-call]
        made.shape = context.make_tuple(builder, one, [count])
        made.strides = context.make_tuple(builder, one, [size])
        return made._getvalue()

    return rows(source, record), generate


def _at(made: Any) -> Any:
    """Return the code that converts an address to a pointer."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:  # noqa: ARG001
        number = builder.fptosi(values[0], context.get_value_type(types.int64))
        return builder.inttoptr(number, context.get_value_type(made))

    return generate


def _rows_at(_: Any, address: Any, record: Any) -> tuple[Any, Any]:
    made = RecordPointer(record.dtype)  # type: ignore[no-untyped-call]
    return made(address, record), _at(made)


def _integers_at(_: Any, address: Any) -> tuple[Any, Any]:
    made = types.CPointer(types.int64)  # type: ignore[no-untyped-call]
    return made(address), _at(made)


if TYPE_CHECKING:

    def as_record(source: Any, record: RecordType[T]) -> T:
        """Return the record at a pointer, or at the beginning of an array."""

    def as_rows(source: Any, record: RecordType[T]) -> Rows[T]:
        """Return the records at a pointer, or in a contiguous array, whose length is then known.

        The memory is the caller's, and has to outlive them.
        """

    def rows_at(address: float, record: RecordType[T]) -> Rows[T]:
        """Return the records at an address, which is a whole number below 2^53, as all are."""

    def integers_at(address: float) -> NDArray[np.int64]:
        """Return the 64-bit integers at an address."""
else:
    as_record, as_rows = intrinsic(_as_record), intrinsic(_as_rows)
    rows_at, integers_at = intrinsic(_rows_at), intrinsic(_integers_at)
