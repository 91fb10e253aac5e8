"""Keyword options that several constructors of trajectories share."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, Literal, TypedDict, TypeVar, cast

from numpy.typing import ArrayLike

from crowdbot.core.trajectories.own_recordings import Samples

#: Arrival time of the robot, s; None: it did not arrive; ``"derived"``: from its goal.
GoalTime = float | Literal["derived"] | None
_Function = TypeVar("_Function", bound=Callable[..., Any])


class PeopleOptions(TypedDict, total=False):
    """Size and mass of people, if tables do not contain them."""

    agent_radius: float
    agent_mass: float


class TimeOptions(TypedDict, total=False):
    """Options for sampling rows of people."""

    resample: Samples
    clock_offset: float
    max_gap: float


class TaskOptions(TypedDict, total=False):
    """The robot, its task and the walls."""

    robot_radius: float | None
    robot_mass: float | None
    robot_goal_time: GoalTime
    robot_goal: tuple[float, float] | None
    robot_goal_radius: float
    robot_speed_limit: float | None
    goal_zone: ArrayLike | None
    walls: ArrayLike | None


class DataSetOptions(PeopleOptions, TaskOptions):
    """Keyword options of constructors that read data sets of people."""


class TopicOptions(PeopleOptions, TimeOptions, TaskOptions):
    """Keyword options of constructors that read topics of a bag."""


class TableOptions(TopicOptions, total=False):
    """Keyword options of constructors that read tables."""

    planner_step_time: ArrayLike | None
    robot_footprint: ArrayLike | None
    signals: Mapping[str, ArrayLike] | None


#: Option -> its value where a constructor has no other.
DEFAULTS: Mapping[str, Any] = {
    **dict.fromkeys(TableOptions.__annotations__),
    "agent_radius": 0.25,
    "agent_mass": 70.0,
    "clock_offset": 0.0,
    "max_gap": 1.0,
    "robot_goal_time": "derived",
    "robot_goal_radius": 0.0,
}


def takes(options: type, **defaults: object) -> Callable[[_Function], _Function]:
    """Give a constructor with ``**options: Unpack[...]`` a signature that names each of them.

    It fills in what is left out, and refuses other keywords with TypeError.

    Args:
        options: the typed dictionary.
        defaults: values that differ from `DEFAULTS`.
    """

    def decorate(function: _Function) -> _Function:
        own = inspect.signature(function)
        named = [p for p in own.parameters.values() if p.kind is not p.VAR_KEYWORD]
        for name, hint in options.__annotations__.items():
            default = defaults.get(name, DEFAULTS[name])
            kind = inspect.Parameter.KEYWORD_ONLY
            text = hint.__forward_arg__
            named.append(inspect.Parameter(name, kind, default=default, annotation=text))
        signature = own.replace(parameters=named)

        @wraps(function)
        def checked(*given: Any, **keywords: Any) -> Any:
            bound = signature.bind(*given, **keywords)
            bound.apply_defaults()
            return function(*bound.args, **bound.kwargs)

        cast(Any, checked).__signature__ = signature
        return cast(_Function, checked)

    return decorate
