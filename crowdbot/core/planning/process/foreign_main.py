"""Run a planner in a Python without crowdbot: ``foreign_main.py FILE CLASS``.

That Python runs this file as a script. It uses only the standard library and the two files beside
it, and supports Python 3.8. If that Python has numpy, planners get arrays, else tuples of numbers.
They may ``import crowdbot_planner``, which has the names below.
"""

from __future__ import annotations

import contextlib
import faulthandler
import importlib.util
import inspect
import math
import os
import platform
import signal
import sys
import traceback
import types
from collections import namedtuple
from typing import Any

_HERE = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120 - as everywhere below
_METHODS = ("reset", "step")

Command = namedtuple("Command", "v w vy", defaults=(0.0,))
Pose = namedtuple("Pose", "x y yaw")
Task = namedtuple("Task", "start goal goal_zone time_limit robot person")
PersonTask = namedtuple(
    "PersonTask", "kind distance tolerance angle hold in_a_row knows radius side"
)
PersonEstimate = namedtuple("PersonEstimate", "x y heading vx vy age")
RobotBody = namedtuple("RobotBody", "drive radius footprint front back half_width")
RobotLimits = namedtuple("RobotLimits", "v_min v_max w_max a_max alpha_max command_timeout vy_max")
Pinhole = namedtuple("Pinhole", "width height focal colour")
SensorInfo = namedtuple(
    "SensorInfo",
    "category frame mount tilt rate shape ros_type angles range_min range_max camera privileged",
)
Reading = namedtuple("Reading", "stamp values colour")
Truth = namedtuple(
    "Truth", "pose velocity people people_velocity people_radius people_id people_notice"
)
Observation = namedtuple(
    "Observation", "t pose twist vy goal goal_zone readings log truth draw person"
)
#: A planner may raise this if it has no valid command; the robot is stopped.
NoValidCommand = type("NoValidCommand", (Exception,), {})


def _beside(name: str) -> Any:
    """Import a module that lies beside this file."""
    spec = importlib.util.spec_from_file_location(
        "crowdbot_" + name,
        os.path.join(_HERE, name + ".py"),  # noqa: PTH118
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["crowdbot_" + name] = module
    spec.loader.exec_module(module)
    return module


class ForeignSide:
    """One planner: finds, builds and calls it.

    Args:
        file, name: location of its class.
        serving: the module of that name.
        array: function that builds arrays.
    """

    def __init__(self, file: str, name: str, serving: Any, array: Any) -> None:
        self._file, self._name, self._serving = file, name, serving
        self._decoder = serving.Decoder(sys.modules[__name__], array)
        self._kind: Any = None
        self._parameters: dict[str, Any] = {}
        self._planner: Any = None
        self._signals: list[list[Any]] = []
        self._drawings: list[list[Any]] = []
        self._doing = ""

    def hello(self, sent: dict[str, Any]) -> dict[str, Any]:
        """Find the class and return its description."""
        self._doing = "cannot be imported"
        self._parameters = sent["parameters"]
        self._kind = self._class()
        self._doing = "parameters"
        with contextlib.suppress(ValueError):  # a class without a signature fails when called
            inspect.signature(self._kind).bind(**self._parameters)
        self._doing = "what it says of itself"
        return {
            "type": "hello", "protocol": self._serving.PROTOCOL, "arrays": "shared",
            "runtime": f"{platform.python_implementation()} {platform.python_version()}",
            **self._serving.described(self._kind),
        }  # fmt: skip

    def reset(self, sent: dict[str, Any]) -> dict[str, Any]:
        """Build the planner and reset it."""
        self._doing = "cannot be built"
        self._decoder.open_memory(sent["memory"])
        self._planner = self._kind(**self._parameters)
        self._doing = "reset"
        self._planner.reset(
            self._decoder.task(sent["task"]), self._decoder.limits(sent["limits"]),
            self._decoder.sensors(sent["sensors"]), sent["seed"],
        )  # fmt: skip
        return {"type": "ready"}

    def observe(self, sent: dict[str, Any]) -> dict[str, Any]:
        """Run one step."""
        self._doing = "step"
        self._signals, self._drawings = [], []
        answer = self._planner.step(self._decoder.observation(sent, self._log, self._draw))
        noted = {"signals": self._signals, "drawings": self._drawings}
        return {"type": "command", **_command(answer), **noted}

    def error(self, error: BaseException) -> dict[str, Any]:
        """Convert an exception to a message; ``NoValidCommand`` stops the robot."""
        signals, self._signals = self._signals, []
        if self._doing == "step" and type(error).__name__ == "NoValidCommand":
            return {"type": "stop", "signals": signals}
        text = f"{self._doing}: {_error_text(error)}{self._where(error)}"
        return {"type": "error", "text": text, "signals": signals}

    def _class(self) -> Any:
        folder = os.path.dirname(self._file)  # noqa: PTH120
        if folder not in sys.path:
            sys.path.append(folder)
        spec = importlib.util.spec_from_file_location("crowdbot_planner_file", self._file)
        if spec is None or spec.loader is None:
            raise ImportError(f"{self._file} is not a Python file")
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
        kind = getattr(module, self._name, None)
        if not inspect.isclass(kind):
            raise ImportError(f"{self._file}: no class '{self._name}'")
        missing = [m for m in _METHODS if not callable(getattr(kind, m, None))]
        if missing:
            raise ImportError(
                f"class '{self._name}' is not a planner: no {' and no '.join(missing)}"
            )
        return kind

    def _log(self, name: str, value: float) -> None:
        if not isinstance(name, str) or not name:
            raise TypeError(f"log: the name of a signal is text, not {name!r}")
        self._signals.append([name, float(value)])

    def _draw(self, name: str, rows: Any, text: Any = None) -> None:
        if not isinstance(name, str) or not name:
            raise TypeError(f"draw: the name of a drawing is text, not {name!r}")
        table = rows() if callable(rows) else rows
        drawing: list[Any] = [name, [[float(x) for x in row] for row in table]]
        if text is not None:
            texts = [text] if isinstance(text, str) else text
            if not isinstance(texts, (list, tuple)) or not all(isinstance(x, str) for x in texts):
                raise TypeError(f"draw: '{name}' has one text or a list of texts, not {text!r:.40}")
            drawing.append(text if isinstance(text, str) else list(text))
        self._drawings.append(drawing)

    def _where(self, error: BaseException) -> str:
        """Return the innermost line in the planner's own files."""
        folder = os.path.dirname(self._file)  # noqa: PTH120
        frames = traceback.extract_tb(error.__traceback__)
        own = [f for f in frames if f.filename.startswith(folder)]
        return f" ({own[-1].filename}:{own[-1].lineno})" if own else ""


def _command(answer: Any) -> dict[str, float]:
    """Convert a result to three numbers.

    Raises:
        ValueError: it is not a command.
    """
    fine = isinstance(answer, tuple) and len(answer) in (2, 3)
    if fine and not any(isinstance(x, (bool, str, bytes, complex)) for x in answer):
        numbers = [float(x) for x in answer]
        if all(math.isfinite(x) for x in numbers):
            v, w, *vy = numbers
            return {"v": v, "w": w, "vy": vy[0] if vy else 0.0}
    raise ValueError(
        f"{repr(answer)[:80]} was returned; a Command(v, w) or a tuple of 2 or 3 finite numbers "
        "is wanted"
    )


def _error_text(error: BaseException) -> str:
    try:
        text = str(error)
    except BaseException as another:
        text = f"(its text raises {type(another).__name__})"
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _arrays(serving: Any) -> Any:
    try:
        import numpy  # noqa: F401 - whether it is there
    except ImportError:
        return serving.tuple_array
    return serving.numpy_array


def main(file: str, name: str) -> None:
    """Serve one planner until the simulator closes the connection."""
    sys.path[:] = [p for p in sys.path if os.path.abspath(p or ".") != _HERE]  # noqa: PTH100
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    faulthandler.enable()
    sys.stdout.reconfigure(line_buffering=True, errors="replace")  # type: ignore[union-attr]
    offered = types.ModuleType("crowdbot_planner", __doc__)
    for public in ("Command", "Pose", "NoValidCommand"):
        setattr(offered, public, globals()[public])
    sys.modules["crowdbot_planner"] = offered
    serving = _beside("serving")
    try:
        from msgpack import packb, unpackb
    except ImportError:
        small = _beside("small_msgpack")
        packb, unpackb = small.packb, small.unpackb
    side = ForeignSide(os.path.abspath(file), name, serving, _arrays(serving))  # noqa: PTH100
    serving.serve(serving.Line(packb, unpackb), side)


if __name__ == "__main__":
    main(*sys.argv[1:3])
    sys.stdout.flush()
    os._exit(0)
