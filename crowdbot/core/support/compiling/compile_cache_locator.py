"""Detect out-of-date compiled functions for numba, ours and those of plugins."""

from __future__ import annotations

import os
from pathlib import Path
from types import FunctionType
from typing import Any

from numba.core.caching import UserProvidedCacheLocator

from crowdbot.core.support.compile_cache import (
    SIMULATORS,
    is_plain_numba,
    is_readable_only,
)
from crowdbot.core.support.compiling.compile_cache_file import check_all_cache_files
from crowdbot.core.support.compiling.compiled_state import CompiledState


class CompiledStateLocator(UserProvidedCacheLocator):
    """Numba's locator for ``NUMBA_CACHE_DIR``, with a stamp of the function's dependencies."""

    def __init__(self, py_func: FunctionType, py_file: str) -> None:
        super().__init__(py_func, py_file)  # type: ignore[no-untyped-call]
        self._function = py_func
        self._reads = is_readable_only(py_file) and not is_plain_numba()
        if self._reads:
            inner = self.get_suitable_cache_subpath(py_file)  # type: ignore[no-untyped-call]
            self._cache_path = str(Path(os.environ[SIMULATORS], inner))

    def ensure_cache_path(self) -> None:
        """Check that the folder can be written, unless this process only reads it."""
        if not self._reads:
            super().ensure_cache_path()  # type: ignore[no-untyped-call]

    def get_source_stamp(self) -> Any:
        """Return the state that must be unchanged for compiled code to be reused."""
        return CompiledState(self._function)


check_all_cache_files()  # numba imports this module before it opens the first of them
