"""Compiles what only compiled code calls without what Python would need to call it.

Numba makes three functions of each: the function itself, one that takes Python's objects apart
and one for C, and turns all three into machine code. A part of a loop needs none but the first,
and that only as LLVM's intermediate code, which is optimised anew, and becomes machine code, within
each function that calls it. Measured over a first run, the other two are more than half of what
LLVM is given.

A function is compiled as a part when another compiled function calls it. Where Python, or C by
address, calls it with the same types, what these need is added and kept beside the part.
"""
# Numba has no types of its own. What is overridden here is not in its documentation.
# mypy: disable-error-code="misc,no-untyped-call,attr-defined"

from __future__ import annotations

import fcntl
import hashlib
import importlib
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

from llvmlite import binding as llvm  # type: ignore[import-untyped]
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import _FunctionCompiler
from numba.core.errors import ForceLiteralArg
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.types import Omitted

from crowdbot.core.support.seldom_collected import seldom_collected

_PART, _WHOLE = "part", "whole"
#: Held while a function is written to the cache.
SAVING = threading.Lock()


class _NoEngine:
    """A part has no machine code, and so no global variables to be set in it."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, name: str, environment: object) -> None:
        del name, environment

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class _PartLibrary(JITCodeLibrary):
    """One function as intermediate code, which never becomes machine code by itself."""

    @property
    def codegen(self) -> Any:
        return _NoEngine(self._codegen)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        del name
        return 0

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        return self.name, _PART, self._get_module_for_linking().as_bitcode()


class _PartContext:
    """What numba reads a part from the cache with, in place of its own context."""

    def __init__(self, context: Any) -> None:
        self._context = context

    def codegen(self) -> Any:
        return self

    def unserialize_library(self, serialized: tuple[str, str, bytes]) -> _PartLibrary:
        name, _, bitcode = serialized
        library = _PartLibrary(self._context.codegen(), name)
        library._final_module = llvm.parse_bitcode(bitcode)
        library._finalize_final_module()
        return library

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)


class _CacheFiles(CompileResultCacheImpl):
    """Keeps, with a function that is whole, all constants that it looks up.

    A part and what was made of it share one environment. Who has read that of the part, be it with
    one of its callers, lacks the constants that are needed to hand Python an array.
    """

    def reduce(self, result: Any) -> Any:
        payload = super().reduce(result)
        return payload if _is_part(result) else (*payload, tuple(result.environment.consts))

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        if payload[0][1] == _PART:
            part: Any = super().rebuild(_PartContext(target_context), payload)
            return part._replace(target_context=target_context)
        *rest, constants = payload
        known = rest[2].consts
        known.extend(constants[len(known) :])
        return super().rebuild(target_context, rest)


class _Cache(FunctionCache):
    """Keeps a function whole and as a part, whichever was compiled."""

    _impl_class = _CacheFiles
    _as_part = False

    def load(self, sig: Any, context: Any, as_part: bool) -> Any:
        self._as_part = as_part
        return self.load_overload(sig, context)

    def save(self, sig: Any, result: Any, as_part: bool) -> None:
        self._as_part = as_part
        with SAVING:
            self.save_overload(sig, result)

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Wait while another process compiles this function.

        A process that holds one waits for those that it calls, so none waits for itself. Where
        the file system knows no locks, both compile.
        """
        place = int.from_bytes(hashlib.sha256(self._cache_file._index_path.encode()).digest()[:5])
        try:
            self._impl.locator.ensure_cache_path()
            file = _lock_file(Path(self.cache_path) / "compiling.lock")
            fcntl.lockf(file, fcntl.LOCK_EX, 1, place)
        except OSError:
            yield
            return
        try:
            yield
        finally:
            fcntl.lockf(file, fcntl.LOCK_UN, 1, place)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        key = super()._index_key(sig, codegen)
        return (*key, _PART if self._as_part else _WHOLE)


@cache
def _lock_file(path: Path) -> int:
    """Open for as long as this process lives: locks go when any file of that path is closed."""
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)


class _PartPipeline(Compiler):
    def compile_extra(self, func: Any) -> Any:
        if self.state.flags.no_cpython_wrapper:
            library = _PartLibrary(self.state.targetctx.codegen(), func.__qualname__)
            library.enable_object_caching()
            self.state.library = library
        return super().compile_extra(func)


class _Compiler(_FunctionCompiler):
    as_part = False

    def _customize_flags(self, flags: Any) -> Any:
        flags.no_cpython_wrapper = flags.no_cfunc_wrapper = self.as_part
        return flags


class KernelDispatcher(CPUDispatcher):
    """As numba's, but compiles what is called by compiled code as a part only."""

    def __init__(
        self,
        py_func: Callable[..., Any],
        locals: dict[str, Any] | None = None,
        targetoptions: dict[str, Any] | None = None,
    ) -> None:
        super().__init__(py_func, locals, targetoptions, _PartPipeline)
        self._compiler = _Compiler(
            py_func, self.targetdescr, self.targetoptions, self.locals, _PartPipeline
        )
        self._cache = _Cache(py_func)
        self._called_by_compiled = False
        self._parts: dict[Any, Any] = {}

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Types of a call from compiled code."""
        with global_compiler_lock:
            before, self._called_by_compiled = self._called_by_compiled, True
            try:
                return super().get_call_template(args, kws)
            finally:
                self._called_by_compiled = before

    def compile(self, sig: Any) -> Any:
        """Compile for arguments, as a part if compiled code asks.

        Numba's own does the same, and times each call of LLVM, which takes a twentieth of all.
        """
        with global_compiler_lock, seldom_collected():
            if not self._can_compile:
                raise RuntimeError("compilation disabled")
            with self._compiling_counter:
                arguments = tuple(normalize_signature(sig)[0])
                known: Any = self.overloads.get(arguments)
                if known is None or (_is_part(known) and not self._called_by_compiled):
                    _leave_scipy()
                    known = self._loaded(sig) or self._compiled_once(sig, arguments)
                return known.entry_point

    def _loaded(self, sig: Any) -> Any:
        for as_part in (False, True)[: 1 + self._called_by_compiled]:
            found = self._cache.load(sig, self.targetctx, as_part)
            if found is not None:
                self._cache_hits[sig] += 1
                self._keep(found)
                _let_others_call(found)
                return found
        return None

    def _compiled_once(self, sig: Any, arguments: Any) -> Any:
        with self._cache.turn():
            return self._loaded(sig) or self._compiled(sig, arguments)

    def _compiled(self, sig: Any, arguments: Any) -> Any:
        self._cache_misses[sig] += 1
        as_part = self._called_by_compiled
        part = None
        if not as_part:
            part = self._parts.get(arguments) or self._cache.load(sig, self.targetctx, as_part=True)
        about = {"dispatcher": self, "args": arguments, "return_type": None}
        with event.trigger_event("numba:compile", data=about):
            result = self._translated(sig, as_part) if part is None else self._whole(part)
        self._keep(result)
        self._cache.save(sig, result, as_part)
        return result

    def _translated(self, sig: Any, as_part: bool) -> Any:
        self._compiler.as_part = as_part
        try:
            return self._compiler.compile(*normalize_signature(sig))
        except ForceLiteralArg as error:
            raise error.bind_fold_arguments(
                lambda given, named: self._compiler.fold_argument_types(given, named)[1]
            ) from None

    def _whole(self, part: Any) -> Any:
        """A part with what Python and C call; the part itself is not translated again."""
        # A part read from the cache has a context of all functions, which hands out no new array.
        makes_arrays = self.targetoptions.get("_nrt", True)
        context = part.target_context.subtarget(enable_nrt=makes_arrays)
        description, environment = part.fndesc, part.environment
        library = context.codegen().create_library(description.qualname)
        library.enable_object_caching()
        library.add_linking_library(part.library)
        context.create_cpython_wrapper(library, description, environment, None)
        if not any(isinstance(a, Omitted) for a in part.signature.args):
            context.create_cfunc_wrapper(library, description, environment, None)
        entry = context.get_executable(library, description, environment)
        whole = part._replace(library=library, entry_point=entry, target_context=context)
        _let_others_call(whole)
        return whole

    def _keep(self, result: Any) -> None:
        """For callers; a part is nothing that Python could call."""
        arguments = tuple(result.signature.args)
        if _is_part(result):
            self._parts[arguments] = self.overloads[arguments] = result
        else:
            self.add_overload(result)
            for environment in result._find_referenced_environments():
                result.library.codegen.set_env(environment.env_name, environment)


@cache
def _leave_scipy() -> None:
    """Have numba take for granted that there is a BLAS.

    It imports scipy.linalg to find out, which takes 0.2 s. Where a function multiplies matrices
    it looks again.
    """
    from numba.np import linalg  # a hundred modules, which only a first call needs

    look, linalg.ensure_blas = linalg.ensure_blas, lambda: None
    try:
        importlib.import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = look


def _is_part(result: Any) -> bool:
    return isinstance(result.library, _PartLibrary)


def _let_others_call(result: Any) -> None:
    """What numba does by itself with what it has just translated."""
    context, library = result.target_context, result.library
    context.insert_user_function(result.entry_point, result.fndesc, [library])


__all__ = ["SAVING", "KernelDispatcher"]
