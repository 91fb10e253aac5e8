"""Compilation with numba's own decorator, without `compile_parts`."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

LOOPS = """
import sys
import numpy as np
from crowdbot.core.support.compiling.compile import array_kernel, declared_kernel
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from numba import float64
@kernel
def twice(values, i):
    return values[i] * 2.0
@inline_kernel
def thrice(values, i):
    return values[i] * 3.0
@array_kernel
def of_all(values):
    found = np.zeros(values.shape[0])
    for i in range(values.shape[0]):
        found[i] = twice(values, i) + thrice(values, i)
    return found
@declared_kernel(float64(float64))
def half(value):
    return 0.5 * value
parts = "crowdbot.core.support.compiling.compile_parts"
print(*of_all(np.arange(3.0)), half(3.0), parts in sys.modules)
"""


@pytest.mark.slow
@pytest.mark.parametrize("plain", [True, False])
def test_plain_numba_leaves_compile_parts_out(tmp_path: Path, plain: bool) -> None:
    file = tmp_path / "loops.py"
    file.write_text(LOOPS, encoding="utf-8")
    environment = {
        **os.environ, "CROWDBOT_PLAIN_NUMBA": str(int(plain)),
        "NUMBA_CACHE_DIR": str(tmp_path / "kernels"),
    }  # fmt: skip
    done = subprocess.run(
        [sys.executable, str(file)], env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["0.0", "5.0", "10.0", "1.5", str(not plain)]
