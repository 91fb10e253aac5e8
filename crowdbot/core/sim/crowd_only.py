"""Simulate and record a crowd alone, without Drake."""

from __future__ import annotations

from collections.abc import Callable

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks


def run_crowd(
    engine: CrowdEngine,
    log: RunLog,
    duration: float,
    log_rate: float,
    *,
    on_sample: Callable[[float], None] | None = None,
    stop: Callable[[], bool] = lambda: False,
) -> bool:
    """Simulate for ``duration`` seconds.

    Args:
        log_rate: samples per second, Hz.
        on_sample: callback with the simulated time after each sample.
        stop: called at each sample; True ends the run.

    Returns:
        True if it ran to the end.
    """
    flat = engine.initial_state()
    per_sample, last = ticks(log_rate), round(duration * TICKS_PER_SECOND)
    tick = 0
    while True:  # at each tick with a possible record
        log.record_events(flat)
        if tick % per_sample == 0:
            log.sample(tick * TICK, None, flat)
            if on_sample is not None:
                on_sample(tick * TICK)
            if stop():
                log.finish(tick * TICK, flat)
                return False
        if tick % TICKS_PER_SECOND == 0:
            log.writer.flush()
        if tick >= last:
            log.finish(duration, flat)
            return True
        pause = min(
            per_sample - tick % per_sample, TICKS_PER_SECOND - tick % TICKS_PER_SECOND, last - tick
        )
        tick += engine.advance_alone(flat, pause)
