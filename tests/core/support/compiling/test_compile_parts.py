"""What only compiled code calls is compiled as a part; what Python calls is whole."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import njit, types

from crowdbot.core.support.compiling.compile import array_kernel, declared_kernel, kernel
from crowdbot.core.types.arrays import Array


@kernel
def _twice(values: Array, i: int) -> float:
    if i > 100:
        raise ValueError("too far")
    return float(values[i] * 2.0)


@array_kernel
def _all_twice(values: Array) -> Array:
    twice = np.zeros(values.shape[0])
    for i in range(values.shape[0]):
        twice[i] = _twice(values, i)
    return twice


@njit
def _twice_and_one(values: Array, i: int) -> float:
    return _twice(values, i) + 1.0


@kernel
def _half(value: float) -> float:
    return value / 2.0


@njit(types.float64(types.float64[::1], types.int64))
def _twice_at_once(values: Array, i: int) -> float:
    return _twice(values, i)


@declared_kernel(types.float64(types.float64))
def _third(value: float) -> float:
    return value / 3.0


@array_kernel
def _times(values: Array) -> Array:
    return values @ values


VALUES = np.arange(4.0)


def test_compiled_code_and_python_call_the_same_function() -> None:
    assert _all_twice(VALUES).tolist() == [0.0, 2.0, 4.0, 6.0]
    calls: Any = _twice_and_one  # as an author of a plugin compiles
    assert calls(VALUES, 3) == 7.0
    assert _twice(VALUES, 3) == 6.0
    assert _twice(VALUES[::2], 1) == 4.0
    assert _twice.py_func(VALUES, 3) == 6.0  # type: ignore[attr-defined]


def test_an_error_in_a_part_reaches_python() -> None:
    functions: tuple[Any, ...] = (_twice_and_one, _twice)
    for function in functions:
        with pytest.raises(ValueError, match="too far"):
            function(np.zeros(200), 150)


def test_c_has_an_address() -> None:
    from crowdbot.core.crowd.velocity_search.cost_calls import address_of

    assert _half(3.0) == 1.5
    assert address_of(_half, types.float64(types.float64)) > 0


def test_a_declared_one_is_compiled_for_its_signature_alone() -> None:
    declared: Any = _third
    assert declared.nopython_signatures == [types.float64(types.float64)]
    assert declared(6) == 2.0  # as C would, Python's numbers are made to fit
    with pytest.raises(TypeError, match="No matching definition"):
        declared(VALUES)


def test_another_process_can_be_sent_one() -> None:
    """As numba does it, which makes a new one there."""
    sent: Any = _half
    state = {**sent._reduce_states(), "uuid": "of another process"}
    arrived = type(sent)._rebuild(**state)
    assert arrived is not sent
    assert arrived(3.0) == 1.5


SCRIPT = """
import json, sys
import crowdbot.core
from numba.core import event
import numpy as np
sys.path.insert(0, sys.argv[1])
import loops
class Listener(event.Listener):
    names = []
    def on_start(self, told):
        self.names.append(told.data["dispatcher"].__name__)
    def on_end(self, told):
        pass
event.register("numba:compile", Listener())
for name in sys.argv[2:]:
    print(np.ravel(getattr(loops, name)(np.arange(3.0)))[0], file=sys.stderr)
ours = [n for n in Listener.names if hasattr(loops, n)]
print(json.dumps(ours))
"""
LOOPS = """
from typing import NamedTuple
import numpy as np
from crowdbot.core.support.compiling.compile import array_kernel, kernel
@kernel
def inner(values):
    return values[1] * 3.0
@kernel
def outer(values):
    return inner(values) + 1.0
@kernel
def other(values):
    return inner(values) - 1.0
@kernel
def around(values):
    return outer(values) * 2.0
@array_kernel
def array(values):
    return np.full(1, values[2])
@array_kernel
def of_array(values):
    return array(values)[0] * 2.0
@array_kernel
def also_of_array(values):
    return array(values)[0] * 3.0
class Pair(NamedTuple):
    a: np.ndarray
    b: np.ndarray
@kernel
def of_pair(pair):
    return pair.a[1] + pair.b[2]
@kernel
def around_pair(values):
    return of_pair(Pair(values, values)) * 2.0
def pair(values):
    return of_pair(Pair(values, values))
"""


def _started(folder: Path, *names: str) -> subprocess.Popen[str]:
    (folder / "loops.py").write_text(LOOPS)
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kernels")}
    return subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(folder), *names],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
    )  # fmt: skip


def _ended(process: subprocess.Popen[str]) -> tuple[list[str], list[float]]:
    out, values = process.communicate()
    assert process.returncode == 0, values
    return json.loads(out), [float(v) for v in values.split()]


@pytest.mark.slow
def test_each_is_kept_as_a_part_and_whole(tmp_path: Path) -> None:
    assert _ended(_started(tmp_path, "outer")) == (["outer", "inner"], [4.0])
    # Another function finds the part; Python wants more, which is added to the part.
    assert _ended(_started(tmp_path, "other", "inner")) == (["other", "inner"], [2.0, 3.0])
    assert _ended(_started(tmp_path, "outer", "other", "inner")) == ([], [4.0, 2.0, 3.0])


@pytest.mark.slow
def test_a_caller_is_compiled_of_what_was_read_whole(tmp_path: Path) -> None:
    assert _ended(_started(tmp_path, "outer"))[1] == [4.0]
    assert _ended(_started(tmp_path, "outer", "around")) == (["around"], [4.0, 8.0])


LOADED = """
import sys
import crowdbot.core
import numpy as np
sys.path.insert(0, sys.argv[1])
import loops
loops.outer(np.arange(3.0))
print(loops.outer.overloads[loops.outer.signatures[0]].library._shared_module)
print("numba.typed.typeddict" in sys.modules)
"""


@pytest.mark.slow
def test_reading_leaves_out_what_only_compiling_needs(tmp_path: Path) -> None:
    assert _ended(_started(tmp_path, "outer"))[1] == [4.0]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    command = [sys.executable, "-c", LOADED, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.split() == ["None", "False"]


@pytest.mark.slow
def test_python_gets_an_array_from_what_was_a_part_before(tmp_path: Path) -> None:
    """To make Python's array takes constants that the part has not."""
    assert _ended(_started(tmp_path, "of_array")) == (["of_array", "array"], [4.0])
    assert _ended(_started(tmp_path, "array")) == (["array"], [2.0])
    # The part comes first, with its caller, then what another process has made of it.
    assert _ended(_started(tmp_path, "of_array", "array")) == ([], [4.0, 2.0])
    assert _ended(_started(tmp_path, "also_of_array", "array"))[1] == [6.0, 2.0]


@pytest.mark.slow
def test_python_passes_a_tuple_to_what_was_a_part_before(tmp_path: Path) -> None:
    """Taking it apart needs constants, which numba knows only after a refresh."""
    assert _ended(_started(tmp_path, "around_pair"))[1] == [6.0]
    assert _ended(_started(tmp_path, "pair")) == (["of_pair"], [3.0])


@pytest.mark.slow
def test_two_processes_do_not_compile_the_same_function(tmp_path: Path) -> None:
    both = [_started(tmp_path, "outer"), _started(tmp_path, "outer")]
    compiled: list[Any] = [_ended(process) for process in both]
    assert sorted(names for names, _ in compiled) == [[], ["outer", "inner"]]
    assert [values for _, values in compiled] == [[4.0], [4.0]]


def test_a_call_does_not_import_scipy_unless_matrices_are_multiplied() -> None:
    code = f"""
import sys
from {__name__} import VALUES, _times, _twice_at_once
_twice_at_once(VALUES, 3)
print('scipy.linalg' in sys.modules)
print(_times(VALUES.reshape(2, 2)).tolist(), 'scipy.linalg' in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["False", "[[2.0, 3.0], [6.0, 11.0]] True"]
