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

from crowdbot.core.support.compile_files import PART, CacheFiles, PartLibrary, is_part
from crowdbot.core.support.gc_throttle import seldom_collected

_WHOLE = "whole, with its symbols"
#: Held while a function is written to the cache.
SAVING = threading.Lock()


class _Cache(FunctionCache):
    """Keeps a function whole and as a part, whichever was compiled."""

    _impl_class = CacheFiles
    _as_part = False

    def load(self, sig: Any, context: Any, as_part: bool) -> Any:
        """As numba's, without what only those who compile need, a tenth of a second's work."""
        self._as_part = as_part
        rtsys.initialize(context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, context)

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
        return (*key, PART if self._as_part else _WHOLE)


@cache
def _lock_file(path: Path) -> int:
    """Open for as long as this process lives: locks go when any file of that path is closed."""
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
        if is_part(result):
            self._parts[arguments] = self.overloads[arguments] = result
        else:
            self.add_overload(result)
            for environment in result._find_referenced_environments():
                result.library.codegen.set_env(environment.env_name, environment)


def _let_others_call(result: Any) -> None:
    """What numba does by itself with what it has just translated."""
    context, library = result.target_context, result.library
    context.insert_user_function(result.entry_point, result.fndesc, [library])


def _leave_scipy() -> None:
    """Have numba take for granted that there is a BLAS, also where plugins compile by themselves.

    It imports scipy.linalg to find out, which takes 0.2 s. Where a function multiplies matrices
    it looks again.
    """
    look, linalg.ensure_blas = linalg.ensure_blas, lambda: None
    try:
        importlib.import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = look


_leave_scipy()

__all__ = ["SAVING", "KernelDispatcher"]
