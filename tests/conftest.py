"""For all tests: Ctrl-C works, examples are drawn alike, and what was slow is marked `slow`."""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Generator, Iterator

import pytest
from hypothesis import HealthCheck, settings

from tests import processor_time
from tests.long_tests import LONG, VARIANTS
from tests.skipped_summary import skipped_line

# A shell without job control starts what runs in the background with SIGINT ignored; tests that
# interrupt, and the processes that they start, would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time, so that a change is judged by what it changes. To look for new ones:
# HYPOTHESIS_PROFILE=explore. How many of what is expensive: tests/examples.py.
# On a busy machine an example may take any time.
_any_time = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("repeat", _any_time, derandomize=True, max_examples=25)
settings.register_profile("explore", _any_time, derandomize=False, max_examples=200)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeat"))


@pytest.fixture(autouse=True, scope="session")
def _own_key(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A key for signatures that is not the user's."""
    place = tmp_path_factory.mktemp("key", numbered=True) / "organiser.key"
    usual = os.environ.get("CROWDBOT_KEY")
    os.environ["CROWDBOT_KEY"] = str(place)
    yield
    os.environ.pop("CROWDBOT_KEY")
    if usual is not None:
        os.environ["CROWDBOT_KEY"] = usual


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Import and list the tests without looking for cycles among 600 000 objects that all stay.

    That takes a sixth of the processor time of collecting the tests, in each worker; and looking
    for them after every 700 new objects, as Python does, a twentieth of that of the tests.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.unfreeze()  # all of them are old now, without a walk
        gc.set_threshold(20_000, *gc.get_threshold()[1:])
        gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Let every second worker list the files of a folder from the last to the first.

    Workers list the same files at the same time. Where these have no byte code yet, as in a fresh
    clone, two workers that meet in the middle translate half of them each, which saves 5 s each.
    """
    report = yield
    if isinstance(collector, pytest.Directory) and _is_backward(collector.config):
        report.result.reverse()
    return report


def _is_backward(config: pytest.Config) -> bool:
    """True for every second worker of a run of everything."""
    return _is_whole(config) and os.environ.get("PYTEST_XDIST_WORKER", "gw0")[-1] in "13579"


def _is_whole(config: pytest.Config) -> bool:
    return not config.args or config.args == config.getini("testpaths")


@pytest.hookimpl(tryfirst=True)  # before `-m` chooses
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what was slow; leave long ones out of a run of everything, unless asked for."""
    if _is_backward(config):  # workers have to agree
        items.sort(key=lambda item: item.path.parts)
    slow = processor_time.listed()
    for item in items:
        if processor_time.function_of(item.nodeid) in slow:
            item.add_marker(pytest.mark.slow)
    if os.environ.get("CROWDBOT_ALL_TESTS") or not _is_whole(config):
        return
    long = [item for item in items if item.nodeid.startswith(LONG + VARIANTS)]
    config.hook.pytest_deselected(items=long)
    left = set(long)
    items[:] = [item for item in items if item not in left]


@pytest.hookimpl(wrapper=True, tryfirst=True)  # outside the others: the last line but one
def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> Iterator[None]:
    """Say in one line what this machine could not test."""
    try:
        return (yield)
    finally:
        if line := skipped_line(terminalreporter.stats.get("skipped", [])):
            terminalreporter.write_line(line, yellow=True)
