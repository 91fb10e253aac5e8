"""A worker returns freed memory that the C library would keep."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

from crowdbot.core.campaign.worker_memory import return_freed_memory

SCRIPT = """
from crowdbot.core.campaign.worker_memory import _resident, return_freed_memory
blocks = [bytes(1000) for _ in range(200_000)]
del blocks[:-1]
before = _resident()
assert not return_freed_memory(above=1 << 62)
assert return_freed_memory(above=0)
print((before - _resident()) // 1_000_000)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the C library is not glibc")
def test_what_a_living_object_lies_behind_is_returned() -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True
    )
    assert int(done.stdout) > 100


def test_a_small_process_keeps_its_memory() -> None:
    assert not return_freed_memory(above=1 << 62)
