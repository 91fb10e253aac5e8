"""Detect out-of-date compiled functions for numba, ours and those of plugins."""

from __future__ import annotations

from types import FunctionType
from typing import Any

from numba.core.caching import UserProvidedCacheLocator

from crowdbot.core.support.compiled_state import CompiledState


class CompiledStateLocator(UserProvidedCacheLocator):
    """Numba's locator for ``NUMBA_CACHE_DIR``, with a stamp of the function's dependencies."""

    def __init__(self, py_func: FunctionType, py_file: str) -> None:
        super().__init__(py_func, py_file)  # type: ignore[no-untyped-call]
        self._function = py_func

    def get_source_stamp(self) -> Any:
        """Return the state that must be unchanged for compiled code to be reused."""
        return CompiledState(self._function)
