"""Compile functions called only from compiled code without Python or C wrappers.

Numba generates three functions each: the function itself, a Python wrapper and a C wrapper, and
compiles all three to machine code. A part of a loop needs only the first, as LLVM intermediate
code, which is optimised and compiled within each caller. In a first run, the wrappers are more than
half of LLVM's input.

A function is compiled as a part when another compiled function calls it. If Python, or C by
address, calls it with the same types, the wrappers are added and stored beside the part.
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
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from numba.core import event
from numba.core.caching import FunctionCache
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import _FunctionCompiler
from numba.core.errors import ForceLiteralArg
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys
from numba.core.sigutils import normalize_signature
from numba.core.types import Omitted
from numba.np import linalg

from crowdbot.core.support.compile_cache import lock_file
from crowdbot.core.support.compiling.compile_cache_file import CheckedCacheFile
from crowdbot.core.support.compiling.compile_files import PART, CacheFiles, PartLibrary, is_part
from crowdbot.core.support.gc_throttle import throttled_gc

_WHOLE = "whole, with its symbols"
#: Held while a function is written to the cache.
SAVING = threading.Lock()


class _Cache(FunctionCache):
    """Stores a function whole and as a part, whichever was compiled."""

    _impl_class = CacheFiles
    _as_part = False

    def __init__(self, py_func: Any) -> None:
        super().__init__(py_func)
        found = self._cache_file
        self._cache_file = CheckedCacheFile(
            found._cache_path, self._impl.filename_base, found._source_stamp
        )

    def load(self, sig: Any, context: Any, as_part: bool) -> Any:
        """Load a function as numba does, without data that only compilation needs.

        This saves a tenth of a second.
        """
        self._as_part = as_part
        rtsys.initialize(context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, context)

    def save(self, sig: Any, result: Any, as_part: bool) -> None:
        """Store a function, if the folder can be written: a planner's process may only read it."""
        self._as_part = as_part
        with SAVING, suppress(OSError):
            self.save_overload(sig, result)

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Wait while another process compiles this function.

        A process that holds one lock waits for callees only, so there is no deadlock. Without file
        locks, both compile.
        """
        name = os.path.realpath(self._cache_file._index_path)
        place = int.from_bytes(hashlib.sha256(name.encode()).digest()[:6])
        try:
            self._impl.locator.ensure_cache_path()
            file = _lock_file(lock_file())
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
        return (*key, PART if self._as_part else _WHOLE)


@cache
def _lock_file(path: Path) -> int:
    """Open the lock file for the process's lifetime: closing any handle would release locks."""
    path.parent.mkdir(parents=True, exist_ok=True)
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)


class _PartPipeline(Compiler):
    def compile_extra(self, func: Any) -> Any:
        if self.state.flags.no_cpython_wrapper:
            library = PartLibrary(self.state.targetctx.codegen(), func.__qualname__)
            library.enable_object_caching()
            self.state.library = library
        return super().compile_extra(func)


class _Compiler(_FunctionCompiler):
    as_part = False

    def _customize_flags(self, flags: Any) -> Any:
        flags.no_cpython_wrapper = flags.no_cfunc_wrapper = self.as_part
        return flags


class KernelDispatcher(CPUDispatcher):
    """Numba's dispatcher, but compiles functions called from compiled code as parts only."""

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
        """Return the types of a call from compiled code."""
        with global_compiler_lock:
            before, self._called_by_compiled = self._called_by_compiled, True
            try:
                return super().get_call_template(args, kws)
            finally:
                self._called_by_compiled = before

    def compile(self, sig: Any) -> Any:
        """Compile for argument types, as a part if compiled code requests it.

        Numba's own method does the same, and also times each LLVM call, which takes a twentieth of
        the total.
        """
        with global_compiler_lock, throttled_gc():
            if not self._can_compile:
                raise RuntimeError("compiling is switched off, by NUMBA_DISABLE_JIT")
            with self._compiling_counter:
                arguments = tuple(normalize_signature(sig)[0])
                known: Any = self.overloads.get(arguments)
                if known is None or (is_part(known) and not self._called_by_compiled):
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
        """Return a compiled function with its Python and C wrappers, without compiling it again."""
        # A part from the cache has a context of all functions, which cannot return new arrays.
        makes_arrays = self.targetoptions.get("_nrt", True)
        self.targetctx.refresh()  # as before any compilation; else numba knows no constants yet
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
        """Keep a part for callers; Python cannot call it."""
        arguments = tuple(result.signature.args)
        if is_part(result):
            self._parts[arguments] = self.overloads[arguments] = result
        else:
            self.add_overload(result)
            for environment in result._find_referenced_environments():
                result.library.codegen.set_env(environment.env_name, environment)


def _let_others_call(result: Any) -> None:
    """Register a newly compiled function for callers, as numba does by itself."""
    context, library = result.target_context, result.library
    context.insert_user_function(result.entry_point, result.fndesc, [library])


def _leave_scipy() -> None:
    """Make numba assume that BLAS is available, also for plugins' own compilation.

    Its check imports scipy.linalg, which takes 0.2 s. It is repeated for functions that multiply
    matrices.
    """
    look, linalg.ensure_blas = linalg.ensure_blas, lambda: None
    try:
        importlib.import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = look


_leave_scipy()
