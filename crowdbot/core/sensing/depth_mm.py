"""Convert depth in m to whole millimetres of ROS's ``16UC1``; compiled."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compiling.compile import array_kernel

_FARTHEST = np.float32(65.535)  # m, in millimetres of 16 bits
_PER_METRE = np.float32(1000.0)


@array_kernel
def depth_mm(depth: NDArray[np.floating[Any]]) -> NDArray[np.uint16]:
    """Return millimetres (H, W) of depths in m, rounded to even; 0 if too far or NaN."""
    found = np.empty(depth.shape, np.uint16)
    for r in range(depth.shape[0]):
        for c in range(depth.shape[1]):
            here = depth[r, c]
            near = here <= _FARTHEST
            found[r, c] = np.uint16(np.rint(here * _PER_METRE)) if near else np.uint16(0)
    return found
