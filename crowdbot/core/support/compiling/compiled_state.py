"""Hash of everything that compiled code depends on: the function, its callees, its globals.

Numba keeps compiled code until the function's own file changes. That misses changes of callees in
other files, and discards code after unrelated changes in the same file. Hashed here are byte code
and options of a function, the values of names that it reads, and the same for each function among
them.
"""

from __future__ import annotations

import hashlib
import sys
import types
from collections.abc import Iterator
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

import numba
import numpy as np
from numba.core.types import Type
from numba.core.typing.templates import Signature

_PLAIN = (
    bool, int, float, complex, str, bytes, type(None), type(Ellipsis), Enum,
    np.generic, np.dtype, Type, Signature,
)  # fmt: skip
#: Packages identified by their version alone.
_FOREIGN = sys.stdlib_module_names | {"numpy", "numba", "llvmlite"}
_VERSIONS = f"numba {numba.__version__}, numpy {np.__version__}"
_STATES: WeakKeyDictionary[types.FunctionType, str] = WeakKeyDictionary()


class CompiledState:
    """Compares and pickles as the hash of a function's state, computed on demand.

    Numba asks for it when a function is declared, before later callees in the same file are.
    """

    def __init__(self, function: Any) -> None:
        self._function = function

    def __eq__(self, other: object) -> bool:
        return str(self) == str(other)

    def __hash__(self) -> int:
        return hash(str(self))

    def __str__(self) -> str:
        return state_of(self._function)

    def __reduce__(self) -> tuple[type[str], tuple[str]]:
        return str, (str(self),)


def state_of(function: types.FunctionType) -> str:
    """Return the hash of everything that affects a function's compiled code but its arguments."""
    if function not in _STATES:
        _STATES[function] = "itself"  # for recursive functions
        digest = hashlib.sha256(_VERSIONS.encode())
        for part in _function(function):
            digest.update(part.encode() + b"\0")
        _STATES[function] = digest.hexdigest()
    return _STATES[function]


def _function(function: types.FunctionType) -> Iterator[str]:
    defaults = f"{function.__defaults__} {function.__kwdefaults__}"
    # Numba keeps the name of the module with the code, and imports it where the code is read.
    yield f"def {function.__module__}.{function.__qualname__} {defaults}"
    compiled: Any = function.__globals__.get(function.__name__)
    if getattr(compiled, "py_func", None) is function:
        yield repr(compiled.targetoptions)
    yield from _code(function.__code__, function.__doc__)
    for name in sorted(_names(function.__code__)):
        if name in function.__globals__:
            yield name
            yield from _value(function.__globals__[name], function)
    for cell in function.__closure__ or ():
        yield from _value(cell.cell_contents, function)


def _code(code: types.CodeType, doc: str | None = None) -> Iterator[str]:
    """Yield byte code and the names in it, without source positions or documentation."""
    yield f"{code.co_code.hex()} {code.co_names} {code.co_varnames} {code.co_freevars}"
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _code(constant)
        elif doc is None or constant != doc:
            yield repr(constant)


def _names(code: types.CodeType) -> set[str]:
    inner = (_names(c) for c in code.co_consts if isinstance(c, types.CodeType))
    return set(code.co_names).union(*inner)


def _value(value: Any, reader: types.FunctionType) -> Iterator[str]:
    """Yield a value that a function reads."""
    if isinstance(value, _PLAIN):
        yield f"{type(value).__qualname__} {value!r}"
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    elif isinstance(value, tuple | list):
        for each in value:
            yield from _value(each, reader)
    elif isinstance(value, types.ModuleType):
        yield from _module(value, reader)
    elif isinstance(value, type | types.BuiltinFunctionType | np.ufunc) or _is_foreign(value):
        yield _named(value)
    elif (inner := _inner_function(value)) is not None:
        yield repr(getattr(value, "targetoptions", None))
        yield state_of(inner)
    else:  # Not known to us: anything near may matter.
        yield package_state(package_of(Path(reader.__code__.co_filename)))


def _module(module: types.ModuleType, reader: types.FunctionType) -> Iterator[str]:
    """Yield a module, with the parts that a function may read."""
    yield module.__name__
    if module.__name__.partition(".")[0] not in _FOREIGN:
        for name in sorted(_names(reader.__code__) & vars(module).keys()):
            yield from _value(vars(module)[name], reader)


def _is_foreign(value: Any) -> bool:
    return str(getattr(value, "__module__", "")).partition(".")[0] in _FOREIGN and hasattr(
        value, "__name__"
    )


def _inner_function(value: Any) -> types.FunctionType | None:
    """Return the Python function in a compiled function or intrinsic, or itself."""
    inner = getattr(value, "py_func", getattr(value, "_defn", value))
    return inner if isinstance(inner, types.FunctionType) else None


def _named(value: Any) -> str:
    fields = [getattr(value, each, None) for each in ("_fields", "_field_defaults")]
    return f"{getattr(value, '__module__', '')}.{value.__name__} {fields}"


@cache
def package_of(file: Path) -> Path:
    """Return the folder of a module's outermost package, or the module's own folder."""
    folder = file.parent
    while (folder.parent / "__init__.py").is_file():
        folder = folder.parent
    return folder


@cache
def package_state(folder: Path) -> str:
    """Return the hash of names, sizes and times of a package's sources, or of a lone module's."""
    whole = (folder / "__init__.py").is_file()
    state = hashlib.sha256()
    for file in sorted(folder.rglob("*.py") if whole else folder.glob("*.py")):
        about = file.stat()
        state.update(f"{file.relative_to(folder)} {about.st_size} {about.st_mtime_ns}\n".encode())
    return state.hexdigest()
