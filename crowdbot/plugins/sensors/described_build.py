"""Base of sensors whose description is constant."""

from __future__ import annotations

from typing import Any, Self

from crowdbot.plugin import SensorInfo


class DescribedSensor:
    """A sensor with a constant description, ``_info``."""

    _info: SensorInfo

    @classmethod
    def from_spec(cls, spec: Any, *given: Any) -> Self:
        """Return a sensor from its spec and, if it takes some, its noise generators.

        Args:
            spec: the parameters.
            given: noise generators, and the robot and task, on which it does not depend.
        """
        return cls(spec, *given[:-1])  # type: ignore[call-arg]

    def info(self) -> SensorInfo:
        """Return the constant description."""
        return self._info
