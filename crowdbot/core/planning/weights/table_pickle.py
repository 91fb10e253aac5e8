"""Read pickled tables of tensors with an interpreter of few opcodes; no code is run or imported.

A pickle is a program. Python's own reader runs it, and even with an allow list of names it takes
memory that the program asks for. This interpreter knows the opcodes that PyTorch's ``state_dict``
needs, and replaces the names that such a table calls by descriptions of tensors.
"""

from __future__ import annotations

import pickletools
from collections.abc import Callable
from io import BytesIO
from typing import Any, NamedTuple

from crowdbot.errors import InputError

#: Largest number of opcodes of one pickle.
_MOST_OPCODES = 2_000_000
#: PyTorch's storage class -> numpy's type of its numbers; bfloat16 is read as whole numbers.
STORAGES = {
    "DoubleStorage": "f8", "FloatStorage": "f4", "HalfStorage": "f2", "BFloat16Storage": "bf2",
    "LongStorage": "i8", "IntStorage": "i4", "ShortStorage": "i2", "CharStorage": "i1",
    "ByteStorage": "u1", "BoolStorage": "?",
}  # fmt: skip
_TEXTS = ("BINUNICODE", "SHORT_BINUNICODE", "UNICODE", "BINSTRING", "SHORT_BINSTRING", "STRING")
_NUMBERS = ("BININT", "BININT1", "BININT2", "LONG1", "INT", "BINFLOAT")
_CONSTANTS = {"NONE": None, "NEWTRUE": True, "NEWFALSE": False}
_SILENT = ("PROTO", "FRAME")


class TensorStorage(NamedTuple):
    """Memory shared by tensors: its key in the file, the type and number of its elements."""

    key: str
    dtype: str
    numbers: int


class TensorView(NamedTuple):
    """A tensor: its storage, and offset, shape and strides in elements."""

    storage: TensorStorage
    offset: int
    size: tuple[int, ...]
    stride: tuple[int, ...]


class _Name(NamedTuple):
    """A name that the pickle mentions, and what calling it returns."""

    name: str
    call: Callable[[tuple[Any, ...]], Any] | None


class TablePickle:
    """Reads one pickle after the other from a stream.

    Args:
        stream: bytes in memory.
        where: the file, for messages.
    """

    def __init__(self, stream: BytesIO, where: str) -> None:
        self._stream, self._where = stream, where
        self._stack: list[Any] = []
        self._marks: list[int] = []
        self._memo: dict[int, Any] = {}

    def read(self) -> Any:
        """Return the next object: containers, texts, numbers and `TensorView`.

        Raises:
            InputError: it is damaged, or asks for anything else.
        """
        self._stack, self._marks, self._memo = [], [], {}
        try:
            for count, (opcode, arg, _) in enumerate(pickletools.genops(self._stream)):
                if count > _MOST_OPCODES:
                    raise self._error(f"more than {_MOST_OPCODES} steps in its table")
                if opcode.name == "STOP":
                    return self._pop()
                self._step(opcode.name, arg)
        except (ValueError, IndexError, TypeError, KeyError, AttributeError) as error:
            raise self._error(f"its table is damaged: {error}") from None
        raise self._error("its table has no end")

    def _step(self, name: str, arg: Any) -> None:
        if name in _TEXTS or name in _NUMBERS:
            self._stack.append(arg)
        elif name in _CONSTANTS:
            self._stack.append(_CONSTANTS[name])
        elif name not in _SILENT:
            step = getattr(self, f"_do_{name.lower()}", None)
            if step is None:
                raise self._error(f"its table has the step {name}, which no table of tensors needs")
            step(arg)

    def _error(self, why: str) -> InputError:
        return InputError(f"{self._where}: {why}; nothing of it was run")

    def _pop(self) -> Any:
        if len(self._stack) <= (self._marks[-1] if self._marks else 0):
            raise IndexError("a step lacks its arguments")
        return self._stack.pop()

    def _since_mark(self) -> list[Any]:
        start = self._marks.pop()
        found = self._stack[start:]
        del self._stack[start:]
        return found

    # ---------------------------------------------------------------------- containers
    def _do_mark(self, _: Any) -> None:
        self._marks.append(len(self._stack))

    def _do_empty_dict(self, _: Any) -> None:
        self._stack.append({})

    def _do_empty_list(self, _: Any) -> None:
        self._stack.append([])

    def _do_empty_tuple(self, _: Any) -> None:
        self._stack.append(())

    def _do_tuple(self, _: Any) -> None:
        self._stack.append(tuple(self._since_mark()))

    def _do_tuple1(self, _: Any) -> None:
        self._stack.append((self._pop(),))

    def _do_tuple2(self, _: Any) -> None:
        second, first = self._pop(), self._pop()
        self._stack.append((first, second))

    def _do_tuple3(self, _: Any) -> None:
        third, second, first = self._pop(), self._pop(), self._pop()
        self._stack.append((first, second, third))

    def _do_list(self, _: Any) -> None:
        self._stack.append(self._since_mark())

    def _do_dict(self, _: Any) -> None:
        items = self._since_mark()
        self._stack.append({})
        self._set(items)

    def _do_append(self, _: Any) -> None:
        item = self._pop()
        self._list().append(item)

    def _do_appends(self, _: Any) -> None:
        items = self._since_mark()
        self._list().extend(items)

    def _do_setitem(self, _: Any) -> None:
        value, key = self._pop(), self._pop()
        self._set([key, value])

    def _do_setitems(self, _: Any) -> None:
        self._set(self._since_mark())

    def _list(self) -> list[Any]:
        found = self._stack[-1]
        if not isinstance(found, list):
            raise TypeError("something is added to what is not a list")
        return found

    def _set(self, items: list[Any]) -> None:
        found = self._stack[-1]
        if not isinstance(found, dict) or len(items) % 2:
            raise TypeError("something is set in what is not a mapping")
        for key, value in zip(items[::2], items[1::2], strict=True):
            if not isinstance(key, str | int):
                raise TypeError(
                    "the file of weights is not one: a name in it is neither text nor a number"
                )
            found[key] = value

    # ---------------------------------------------------------------------------- memo
    def _do_binput(self, arg: int) -> None:
        self._memo[arg] = self._stack[-1]

    _do_long_binput = _do_put = _do_binput

    def _do_memoize(self, _: Any) -> None:
        self._memo[len(self._memo)] = self._stack[-1]

    def _do_binget(self, arg: int) -> None:
        self._stack.append(self._memo[arg])

    _do_long_binget = _do_get = _do_binget

    # --------------------------------------------------------------------------- names
    def _do_global(self, arg: str) -> None:
        self._stack.append(self._named(arg.replace(" ", ".")))

    def _do_stack_global(self, _: Any) -> None:
        name, module = self._pop(), self._pop()
        self._stack.append(self._named(f"{module}.{name}"))

    def _named(self, name: str) -> _Name:
        storage = name.removeprefix("torch.")
        if storage in STORAGES:
            return _Name(STORAGES[storage], None)
        if name not in _CALLS:
            raise self._error(
                f"it asks for {name[:100]!a}, which does not belong to a table of tensors: "
                "save the model's state_dict(), not the model"
            )
        return _Name(name, _CALLS[name])

    def _do_reduce(self, _: Any) -> None:
        arguments, name = self._pop(), self._pop()
        if not isinstance(name, _Name) or name.call is None or not isinstance(arguments, tuple):
            raise TypeError(
                "the file of weights is not one: it calls something that is not a function"
            )
        self._stack.append(name.call(arguments))

    def _do_build(self, _: Any) -> None:
        """Drop the state of an ordered mapping: versions of PyTorch's modules."""
        state = self._pop()
        if not isinstance(self._stack[-1], dict) or not isinstance(state, dict):
            raise TypeError(
                "the file of weights is not one: a part of it has a state without names"
            )

    def _do_binpersid(self, _: Any) -> None:
        word, kind, key, _place, count, *rest = self._pop()
        if word != "storage" or not isinstance(kind, _Name) or any(r is not None for r in rest):
            raise TypeError("a storage of an unknown kind")
        if not isinstance(key, str) or type(count) is not int or count < 0:
            raise TypeError("a storage without a key or size")
        self._stack.append(TensorStorage(key, kind.name, count))


def _ordered(arguments: tuple[Any, ...]) -> dict[Any, Any]:
    found: dict[Any, Any] = {}
    for pairs in arguments:
        for key, value in pairs:
            if not isinstance(key, str | int):
                raise TypeError(
                    "the file of weights is not one: a name in it is neither text nor a number"
                )
            found[key] = value
    return found


def _tensor(arguments: tuple[Any, ...]) -> TensorView:
    storage, offset, size, stride = arguments[:4]
    numbers = (offset, *size, *stride)
    if not isinstance(storage, TensorStorage) or any(type(n) is not int for n in numbers):
        raise TypeError("a tensor is not described by whole numbers")
    return TensorView(storage, offset, tuple(size), tuple(stride))


def _parameter(arguments: tuple[Any, ...]) -> TensorView:
    if not isinstance(arguments[0], TensorView):
        raise TypeError("the file of weights is not one: a parameter in it is not a tensor")
    return arguments[0]


_CALLS: dict[str, Callable[[tuple[Any, ...]], Any]] = {
    "collections.OrderedDict": _ordered,
    "torch._utils._rebuild_tensor_v2": _tensor,
    "torch._utils._rebuild_tensor": _tensor,
    "torch._utils._rebuild_parameter": _parameter,
    "torch.Size": lambda arguments: tuple(arguments[0]),
}
