"""How the crowd's loops are compiled.

Compiled code counts references to every array at every call, by locked instructions that cost more
than a neighbour. Functions that make no array need no count: Python holds all of theirs.
"""

from __future__ import annotations

from numba import njit

#: Decorator of compiled functions that only read and write arrays they are given.
kernel = njit(cache=True, error_model="numpy", _nrt=False)

__all__ = ["kernel"]
