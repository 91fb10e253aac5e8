from __future__ import annotations

import pickle
from collections.abc import Callable
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba import njit

from crowdbot.core.support.compiling.compiled_state import CompiledState, state_of

SOURCE = """
SPEED = 1.3
TABLE = np.arange(4.0)
class Walls(NamedTuple):
    start: float
    end: float = 1.0
@njit
def inner(x):
    return x + SPEED
@njit
def outer(x):
    '''Said of it.'''
    return inner(x) * TABLE[1] + Walls(x).end + helpers.half(x)
def unrelated(x):
    return x
"""


def _half(x: float) -> float:
    return x / 2


def outer(source: str = SOURCE, half: Callable[[float], float] = _half) -> Any:
    helpers = ModuleType("helpers")
    vars(helpers)["half"] = half
    space: dict[str, Any] = {
        "np": np, "njit": njit, "NamedTuple": NamedTuple, "helpers": helpers, "__name__": "made"
    }  # fmt: skip
    exec(compile(source, "made.py", "exec"), space)
    return space["outer"].py_func


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("x + SPEED", "x - SPEED"),
        ("1.3", "1.31"),
        ("arange(4.0)", "arange(5.0)"),
        ("end: float = 1.0", "end: float = 2.0"),
        ("start: float", "begin: float"),
        ("@njit\ndef inner", "@njit(fastmath=True)\ndef inner"),
        ("@njit\ndef outer", "@njit(inline='always')\ndef outer"),
    ],
)
def test_what_a_function_depends_on_changes_its_state(old: str, new: str) -> None:
    assert old in SOURCE
    assert state_of(outer()) != state_of(outer(SOURCE.replace(old, new)))


def test_a_function_of_a_module_changes_it() -> None:
    assert state_of(outer()) != state_of(outer(half=lambda x: x / 3))


def test_a_function_that_moves_to_another_module_changes_it() -> None:
    moved = FunctionType(_half.__code__, {**globals(), "__name__": "moved"})
    assert state_of(outer(half=moved)) != state_of(outer())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Said of it", "Said better"),
        ("def unrelated(x):\n    return x", "def unrelated(x):\n    return 2 * x"),
        ("SPEED = 1.3\n", "\n\n# a comment\nSPEED = 1.3\n"),
    ],
)
def test_what_does_not_matter_changes_nothing(old: str, new: str) -> None:
    assert old in SOURCE
    assert state_of(outer()) == state_of(outer(SOURCE.replace(old, new)))


def test_a_function_may_call_itself() -> None:
    source = SOURCE.replace("inner(x) *", "outer(x - 1) *")
    assert state_of(outer(source)) == state_of(outer(source)) != state_of(outer())


def test_numba_keeps_and_compares_it_as_text() -> None:
    state = CompiledState(outer())
    kept = pickle.loads(pickle.dumps(state))  # noqa: S301
    assert isinstance(kept, str)
    assert kept == state
    assert state != CompiledState(outer(SOURCE.replace("1.3", "1.4")))
