"""Record one run, with one robot or several."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.fleet.record import record_fleet
from crowdbot.core.sim.record import record_robot
from crowdbot.core.sim.run_setup import RunSetup


def record_all(setup: RunSetup, builts: Mapping[str, BuiltRun]) -> Outcome:
    """Simulate the scenario's robots: one with `record_robot`, several with `record_fleet`."""
    if len(builts) == 1:
        return record_robot(setup, next(iter(builts.values())))
    return record_fleet(setup, builts)
