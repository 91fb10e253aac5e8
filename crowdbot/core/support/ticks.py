"""Simulated time in integer ticks of 1/128 s, so that event times are exact."""

from __future__ import annotations

TICKS_PER_SECOND = 128
TICK = 1.0 / TICKS_PER_SECOND


def ticks(rate: float) -> int:
    """Return the ticks between events of a rate that divides 128 Hz."""
    return round(TICKS_PER_SECOND / rate)


def is_due(tick: int, rate: float) -> bool:
    """Return True if a sample of a rate up to 128 Hz falls on this tick.

    Sample n is taken on the first tick at or after n / rate.
    """
    samples_before = _samples_until(tick - 1, rate)
    return _samples_until(tick, rate) > samples_before


def _samples_until(tick: int, rate: float) -> int:
    """Return the number of samples n >= 0 with n / rate <= tick / 128."""
    # 8.2 Hz is stored as slightly less; its sample 123 still belongs to the tick at 15 s.
    return int(tick * rate / TICKS_PER_SECOND + 1e-9) + 1 if tick >= 0 else 0
