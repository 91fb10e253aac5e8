"""What commands share that make a run: Ctrl-C."""

from __future__ import annotations

import signal

import pytest

from crowdbot.cli.shared.one_run import interruptible
from crowdbot.core.registry.plugin_errors import UserInterrupt, is_user_interrupt


def test_before_anything_runs_one_interrupt_is_enough() -> None:
    with interruptible(), pytest.raises(UserInterrupt) as raised:
        signal.raise_signal(signal.SIGINT)
    assert is_user_interrupt(raised.value)


def test_the_first_interrupt_of_a_run_asks_and_the_second_insists() -> None:
    before = signal.getsignal(signal.SIGINT)
    with interruptible() as stop:
        assert not stop()
        signal.raise_signal(signal.SIGINT)
        assert stop()
        with pytest.raises(UserInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before
