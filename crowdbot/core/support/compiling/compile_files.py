"""Cache files of compiled functions for numba, and how they are loaded.

A function stored as a part (`compile_parts`) is intermediate code only. A
whole function is machine code, plus intermediate code for compiling its callers. Calls never need
the latter, and loading it takes longer than linking the machine code.
"""
# Numba has no types of its own. What is overridden here is not in its documentation.
# mypy: disable-error-code="misc,no-untyped-call,attr-defined"

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from llvmlite import binding as llvm  # type: ignore[import-untyped]
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary

PART = "part"


class _NoEngine:
    """Engine of a part, which has no machine code and so no global variables to set."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, name: str, environment: object) -> None:
        del name, environment

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class PartLibrary(JITCodeLibrary):
    """One function as intermediate code only, which is compiled as a part of its callers."""

    @property
    def codegen(self) -> Any:
        """Return numba's code generator, without addresses."""
        return _NoEngine(self._codegen)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no address."""
        del name
        return 0

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """Return the cached data in place of machine code."""
        return self.name, PART, self._get_module_for_linking().as_bitcode()


def is_part(result: Any) -> bool:
    """Return True if a compiled function is stored as intermediate code only."""
    return isinstance(result.library, PartLibrary)


class _ReadLibrary(JITCodeLibrary):
    """A whole function from the cache; only names of its intermediate code are known."""

    def __init__(
        self, symbols: Sequence[str], codegen: Any, name: str, code: tuple[bytes, bytes]
    ) -> None:
        super().__init__(codegen, name)
        machine_code, self._bitcode = code
        self.enable_object_caching()
        self._set_compiled_object(machine_code)
        self._finalize_final_module()
        codegen._engine._defined_symbols.update(symbols)

    def _get_module_for_linking(self) -> Any:
        if self._shared_module is None:
            self._shared_module = llvm.parse_bitcode(self._bitcode)
        return self._shared_module


def _symbols_of(library: Any) -> tuple[str, ...]:
    """Return the symbols that a library defines."""
    module = library._get_module_for_linking()
    both = (module.functions, module.global_variables)
    return tuple(one.name for each in both for one in each if not one.is_declaration)


class _ReadingContext:
    """A replacement for numba's context when a function is loaded from the cache."""

    def __init__(self, context: Any, read: Callable[[Any, str, Any], JITCodeLibrary]) -> None:
        self._context, self._read = context, read

    def codegen(self) -> Any:
        return self

    def unserialize_library(self, serialized: tuple[str, str, Any]) -> JITCodeLibrary:
        name, _, code = serialized
        return self._read(self._context.codegen(), name, code)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)


def _read_part(codegen: Any, name: str, bitcode: bytes) -> PartLibrary:
    library = PartLibrary(codegen, name)
    library._final_module = llvm.parse_bitcode(bitcode)
    library._finalize_final_module()
    return library


class CacheFiles(CompileResultCacheImpl):
    """Stores a whole function with its symbols and all constants that it refers to.

    A part and the whole function share one environment. The part's environment, loaded for example
    with a caller, lacks the constants needed to return an array to Python.
    """

    def reduce(self, result: Any) -> Any:
        """Return the data to store."""
        payload = super().reduce(result)
        if is_part(result):
            return payload
        return (*payload, tuple(result.environment.consts), _symbols_of(result.library))

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """Return the function from stored data."""
        if payload[0][1] == PART:
            return self._read(target_context, payload, _read_part)
        *rest, constants, symbols = payload
        known = rest[2].consts
        known.extend(constants[len(known) :])
        return self._read(target_context, rest, partial(_ReadLibrary, symbols))

    def _read(self, context: Any, payload: Any, read: Callable[..., JITCodeLibrary]) -> Any:
        result: Any = super().rebuild(_ReadingContext(context, read), payload)
        return result._replace(target_context=context)
