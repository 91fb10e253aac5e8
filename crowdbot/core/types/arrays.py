"""Names for arrays; their shapes are given in the docstrings of their users."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.int64]
Point = tuple[float, float]
