"""Memory that planners read scans from."""

from __future__ import annotations

import fcntl
import mmap
import os
import sys

import numpy as np
import pytest

from crowdbot.core.planning.process import shared_memory
from crowdbot.core.planning.process.shared_memory import SharedMemory

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="seals are of Linux")


def test_no_other_process_changes_it() -> None:
    memory = SharedMemory()
    memory.place("front", "values", 8000)
    scan = np.arange(1000.0)
    sent = memory.put("front", "values", scan)
    for size in (0, 1 << 30):
        with pytest.raises(PermissionError):
            os.ftruncate(memory.descriptor, size)
    with pytest.raises(PermissionError):
        fcntl.fcntl(memory.descriptor, shared_memory._F_ADD_SEALS, 0x8)
    with pytest.raises(PermissionError):
        mmap.mmap(memory.descriptor, memory.size)
    with pytest.raises(PermissionError):
        os.pwrite(memory.descriptor, b"x", 0)
    read = os.pread(memory.descriptor, sent["bytes"], sent["offset"])
    assert np.array_equal(np.frombuffer(read), scan)
    memory.close()


def test_what_has_no_place_is_sent_in_the_message(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_memory, "LARGEST", 10_000)
    memory = SharedMemory()
    memory.place("front", "values", 8000)
    memory.place("rear", "values", 8000)
    assert "offset" in memory.put("front", "values", np.zeros(1000))
    assert memory.put("rear", "values", np.ones(1000))["data"] == np.ones(1000).tobytes()
    memory.close()
