"""For all tests: Ctrl-C works, examples are drawn alike, and what was slow is marked `slow`."""

from __future__ import annotations

import os
import signal

import pytest
from hypothesis import HealthCheck, settings

from tests import processor_time

# A shell without job control starts what runs in the background with SIGINT ignored; tests that
# interrupt, and the processes that they start, would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples each time, so that a change is judged by what it changes. To look for new ones:
# HYPOTHESIS_PROFILE=explore.
# On a busy machine an example may take any time.
_any_time = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("repeat", _any_time, derandomize=True, max_examples=25)
settings.register_profile("explore", _any_time, derandomize=False, max_examples=200)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeat"))

#: The longest tests, 7 minutes of processor time together: `make test-all` runs them too, so that
#: `make test` ends within 15 minutes on two cores.
LONG = (
    "tests/cli/test_audit.py::test_a_suite_without_people_tells_nothing",
    "tests/cli/test_audit.py::test_floors_are_reused_like_any_other_run",
    "tests/cli/test_campaign.py::test_ctrl_c_ends_workers_and_keeps_what_is_finished",
    "tests/cli/test_campaign.py::test_failures_are_on_record_and_stop_nobody",
    "tests/cli/test_campaign.py::test_references_are_shared_and_replays_left_out",
    "tests/cli/test_campaign.py::test_failures_of_planners_in_the_workers",
    "tests/cli/test_campaign_cluster.py",
    "tests/cli/test_kills.py",
    "tests/plugins/planners/test_outlines.py::test_a_wheelchair",
    "tests/plugins/planners/test_outlines.py::test_pepper",
    "tests/cli/test_planner_processes.py::test_a_hostile_planner_stops_no_campaign",
    "tests/cli/test_planner_processes.py::test_a_worker_is_killed",
    "tests/cli/test_plugins.py::test_show_every_kind",
    "tests/cli/test_plugins_new.py::test_the_other_scenario_runs",
    "tests/cli/test_plugins_new.py::test_the_package_keeps_its_promises",
    "tests/cli/test_serve.py::test_roslibpy_drives_to_the_goal_as_the_same_planner_inside[Twist]",
    "tests/cli/test_simulate.py::test_runs_at_once_are_the_same_run",
    "tests/cli/test_verify_fleet.py::test_scores_of_robots_that_do_not_fit_are_found",
    "tests/cli/test_view.py::test_runs_beside_each_other",
    "tests/core/planning/process/test_same_trajectory.py::test_another_language_drives",
    "tests/core/replay/test_browser.py::test_axe_finds_nothing[dark]",
    "tests/core/replay/test_browser.py::test_pictures_and_clips_are_saved",
    "tests/core/live/test_rosbridge.py::test_two_thousand_come_and_go",
    "tests/docs/test_example_package.py",
    "tests/dsl/test_mutations.py::test_refused_or_understood",
    "tests/dsl/test_safety.py::test_document",
    "tests/dsl/test_schema.py::test_what_the_schema_refuses_validate_refuses",
)


@pytest.hookimpl(tryfirst=True)  # before `-m` chooses
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what was slow; leave the longest out of a run of everything, unless asked for."""
    slow = processor_time.listed()
    for item in items:
        if processor_time.function_of(item.nodeid) in slow:
            item.add_marker(pytest.mark.slow)
    whole = not config.args or config.args == config.getini("testpaths")
    if os.environ.get("CROWDBOT_ALL_TESTS") or not whole:
        return
    long = [item for item in items if item.nodeid.startswith(LONG)]
    config.hook.pytest_deselected(items=long)
    left = set(long)
    items[:] = [item for item in items if item not in left]
