"""Measures which tests are slow: `make durations` writes tests/durations.tsv, conftest.py reads it.

Processor time, of a test and of the processes that it waits for, since a busy machine changes it
less than it changes the time on the clock.
"""

from __future__ import annotations

import resource
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

TABLE = Path(__file__).parent / "durations.tsv"
#: What is quicker, all cases of a function together, is not listed, s.
LISTED = 0.2
_PROPERTY = "processor_time"
_total: defaultdict[str, float] = defaultdict(float)


def function_of(node: str) -> str:
    """A test function's id, without the case."""
    return node.partition("[")[0]


def listed() -> dict[str, float]:
    """Test function -> processor time of all its cases, s; only those above `LISTED`."""
    rows = (line.split("\t") for line in TABLE.read_text(encoding="utf-8").splitlines())
    return {node: float(seconds) for seconds, node in rows}


def _spent() -> float:
    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(used.ru_utime + used.ru_stime for used in both)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> Iterator[None]:
    """Note when a test, with its fixtures, begins."""
    item.user_properties.append((_PROPERTY, -_spent()))
    return (yield)


@pytest.hookimpl(wrapper=True, trylast=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    """Note what it took."""
    item.user_properties.append((_PROPERTY, _spent()))
    return (yield)


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Add up the cases of a function, where all workers' reports arrive."""
    if report.when == "teardown":
        spent = (float(str(v)) for name, v in report.user_properties if name == _PROPERTY)
        _total[function_of(report.nodeid)] += sum(spent)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the table, by name, after a run of everything."""
    config = session.config
    if config.args == config.getini("testpaths") and not hasattr(config, "workerinput"):
        rows = sorted((node, seconds) for node, seconds in _total.items() if seconds > LISTED)
        text = "".join(f"{seconds:.1f}\t{node}\n" for node, seconds in rows)
        TABLE.write_text(text, encoding="utf-8")
