"""Whatever a metric prints while it scores, stdout is what a command answers."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.plugin_packages import HEAD, Site

METRIC = (
    HEAD
    + '''
import os
from crowdbot.plugin import ScoreFactory
from crowdbot.plugin import MetricSpec, declare_metric

class Words(MetricSpec):
    """A metric."""
    kind: Literal["noisy.m"] = "noisy.m"

class Metric:
    def __init__(self, spec):
        pass
    def score(self, run, refs):
        os.write(1, b"chatter\\n")
        return [ScoreFactory(METRIC).ok("corrected", 1.0)]

METRIC = declare_metric(Words, build="plugin_noisy:Metric", symbol="F", unit="m", better="lower",
                        category="task", card="# noisy.m\\n")

@hookimpl
def crowdbot_components():
    return {"metric": [METRIC]}
'''
)


@pytest.mark.slow
@pytest.mark.parametrize("option", [[], ["--no-plugins"]])
def test_evaluate(option: list[str], tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.install("noisy", METRIC)
    commands = tmp_path / "commands.csv"
    commands.write_text("t,v_user,w_user,v_sc,w_sc\n0,1,0,1,0\n1,1,0,1,0\n")
    words = ["evaluate", "--commands", str(commands), "--metrics", "noisy.m", "--json", *option]
    words += ["--v-max", "1", "--w-max", "1"]
    done = site.run(*words)
    if option:
        assert done.returncode == 1
        assert "is installed but not allowed: --no-plugins" in done.stderr
        return
    assert done.returncode == 0, done.stderr
    assert [s["metric"] for s in json.loads(done.stdout)[0]["scores"]] == ["noisy.m"]
    assert "chatter" in done.stderr
