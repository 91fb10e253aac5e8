"""Planners given in Python: a class, an object, a function, or the spec of a kind."""

from __future__ import annotations

import hashlib
import inspect
import pickle
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import FunctionType
from typing import Any, cast

from crowdbot.core.planning.choice import ANYWHERE, PlannerChoice, PlannerPlace, label_of
from crowdbot.core.planning.description import described
from crowdbot.core.planning.files_of_spec import with_absolute_files
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.planning.python_file import (
    build_of_class,
    call_of_class,
    check_parameters,
    checked_planner,
    missing_methods,
)
from crowdbot.core.planning.resolve import resolve_planner, setting_values
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.source_digest import source_digest
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.spec.component_specs import PlannerSpec
from crowdbot.dsl.suite.settings import setting_texts
from crowdbot.errors import InputError, kind_of

#: Types accepted by `choose_planner`: a name or file, a spec, a class, an object, a function.
GivenPlanner = str | Path | PlannerSpec | type[Any] | Planner | Callable[[Observation], Any]


def choose_planner(
    planner: GivenPlanner,
    registry: Registry,
    settings: Sequence[str] | Mapping[str, object] = (),
    place: PlannerPlace = ANYWHERE,
) -> PlannerChoice:
    """Return the choice for a given planner, without building it.

    Args:
        planner: a kind, a YAML file or ``file.py:Class`` as text or path, or those of several
            robots as ``a=KIND,b=FILE``, see `resolve_planner`; a spec such as ``DwaSpec()``; a
            class with ``reset`` and ``step``; an instance of one; or a function from an observation
            to a command.
        registry: the installed components.
        settings: parameters: ``key=value`` texts, or a mapping; none for an object or function.
        place: where a planner with a name or file runs; Python objects run in this process.

    Raises:
        UnknownNameError: no planner of that kind is installed.
        InputError: it is not a planner, or a parameter is wrong.
    """
    if isinstance(planner, str | Path):
        return resolve_planner(str(planner), registry, setting_texts(settings), place)
    if isinstance(planner, PlannerSpec):
        values = planner.model_dump(mode="json", exclude={"kind"})
        values |= {**with_absolute_files(planner), **setting_values(settings)}
        return resolve_planner(_kind(planner), registry, setting_texts(values), place)
    given = setting_values(settings)
    if inspect.isclass(planner):
        return _of_class(planner, given)
    if given:
        raise InputError(
            "planner settings go with a name, a file or a class; "
            f"an object ({type(planner).__name__}) was made with its own"
        )
    if not missing_methods(planner):
        return _made_already(planner, type(planner), lambda: checked_planner(planner), planner)
    if callable(planner) and not hasattr(planner, "step"):
        return _of_function(planner)
    raise InputError(
        f"{kind_of(planner)} is not a planner: a name, a file, a class or object with "
        "reset and step, or a function from an observation to a command is wanted"
    )


def _kind(spec: PlannerSpec) -> str:
    kind = getattr(spec, "kind", None)
    if not isinstance(kind, str):
        raise InputError(f"{type(spec).__name__} has no 'kind': which planner is it?")
    return kind


def _of_class(kind: type[Any], parameters: Mapping[str, Any]) -> PlannerChoice:
    if missing := missing_methods(kind):
        raise InputError(f"class '{kind.__name__}' is not a planner: no {' and no '.join(missing)}")
    check_parameters(kind, parameters, kind.__name__)
    origin, digest = _written(kind)
    name = kind.__name__
    description = described(kind, call_of_class(Path(origin), name))
    file = origin.endswith(".py")
    return PlannerChoice(
        name=name,
        spec_dump={
            "kind": f"{Path(origin).name}:{name}" if file else origin,
            "sha256": source_digest(Path(origin), description.data) if file else digest,
            **({"parameters": dict(parameters)} if parameters else {}),
        },
        build=partial(build_of_class, kind, parameters, Path(origin), name),
        pinned=False,
        origin=origin,
        needs=description.needs,
        label=label_of(name, parameters, description.privileged),
        privileged=description.privileged,
        role="candidate" if parameters else description.role,
    )


class _AskedFunction:
    """A function as a planner, without memory between steps."""

    def __init__(self, function: Callable[[Observation], Any]) -> None:
        self._function = function

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Do nothing."""

    def step(self, obs: Observation) -> Command:
        """Return the function's result, which the host checks."""
        return cast(Command, self._function(obs))


def _of_function(function: Callable[[Observation], Any]) -> PlannerChoice:
    written = function if isinstance(function, FunctionType) else type(function)
    return _made_already(function, written, lambda: _AskedFunction(function), function)


def _made_already(
    given: object, written: Any, build: Callable[[], Planner], holder: object
) -> PlannerChoice:
    """Return the choice for an existing object; its state is part of its identity."""
    origin, digest = _written(written)
    name = str(getattr(written, "__name__", ""))
    name = name if name.isidentifier() else "function"
    needs = getattr(holder, "needs", None)
    privileged = getattr(holder, "privileged", False) is True
    return PlannerChoice(
        name=name,
        spec_dump={"kind": f"python:{name}", "sha256": digest, "state": _state(given)},
        build=build,
        pinned=False,
        needs=None if needs is None else tuple(str(n) for n in needs),
        label=f"{name}+privileged" if privileged else name,
        privileged=privileged,
        origin=origin,
        repeatable=False,
    )


def _state(given: object) -> str:
    """Return a digest of the state of an object or function.

    State that cannot be pickled is identified by its ``repr``, which may differ between processes.
    """
    try:
        return hashlib.sha256(pickle.dumps(given)).hexdigest()
    except Exception:  # any exception type is possible
        cells = getattr(given, "__closure__", None) or ()
        held = [*getattr(given, "__dict__", {}).items(), *(c.cell_contents for c in cells)]
        return hashlib.sha256(repr(held).encode()).hexdigest()


def _written(built: Any) -> tuple[str, str]:
    """Return where a class or function is defined, and the digest of its source.

    Outside a file, such as in a notebook: its name, and the digest of its text.
    """
    name = f"{getattr(built, '__module__', '')}.{getattr(built, '__qualname__', '')}"
    try:
        file = Path(inspect.getfile(built))
        if file.is_file():
            return str(file), source_digest(file)
    except (TypeError, OSError):
        pass
    try:
        text = inspect.getsource(built)
    except (TypeError, OSError):
        text = name
    return name, hashlib.sha256(text.encode()).hexdigest()
