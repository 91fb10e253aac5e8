"""Base classes of the metrics: scores of runs without a value."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any, ClassVar, Generic, TypeVar, get_args

from crowdbot.plugin import (
    MetricComponent,
    MetricSpec,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    truncate_at_arrival,
)

_S = TypeVar("_S", bound=MetricSpec)


class UndefinedError(Exception):
    """A metric, or one of its variants, has no value; the text is the reason."""


class DeclaredMetric(Generic[_S]):
    """Metric whose scores are all undefined if `UndefinedError` is raised.

    Attributes:
        spec: its parameters.
        factory: builds its scores; of the metric that is declared with this spec.
    """

    factory: ClassVar[ScoreFactory]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        (spec,) = get_args(cls.__dict__["__orig_bases__"][0])
        if isinstance(spec, type):
            cls.factory = ScoreFactory(_declared_with(spec))

    def __init__(self, spec: _S) -> None:
        self.spec = spec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Return one score per variant."""
        try:
            return self._scores(run, refs)
        except UndefinedError as error:
            return self.factory.all_undefined(str(error))

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Return one score per variant.

        Raises:
            UndefinedError: no variant has a value.
        """
        raise NotImplementedError


class RobotMetric(DeclaredMetric[_S]):
    """Metric of the robot's drive up to its arrival; undefined without a robot."""

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Return one score per variant, of the run up to the robot's arrival."""
        if run.robot is None:
            return self.factory.all_undefined("invalid_no_robot")
        return super().score(truncate_at_arrival(run), refs)


def _declared_with(spec: type[MetricSpec]) -> MetricComponent[Any]:
    """Return the metric that the module of a spec declares with it."""
    declared = vars(sys.modules[spec.__module__]).values()
    return next(m for m in declared if isinstance(m, MetricComponent) and m.spec is spec)
