"""What a campaign is asked for, as its workers find it."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.campaign.request import CampaignRequest, open_planners
from crowdbot.core.planning.fleet_choice import planners_by_robot
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.registry.registry import discover

MINE = """\
class Mine:
    def reset(self, *_):
        pass

    def step(self, obs):
        return 0, 0
"""


@pytest.mark.parametrize(
    "text", ["mine.py:Mine", "a=dwa,b=mine.py:Mine", "a=mine.py:Mine,b=fast.yaml", "dwa"]
)
def test_a_planner_is_found_from_another_working_directory(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Files of one planner, or of each robot's, are absolute in what workers are given."""
    (tmp_path / "mine.py").write_text(MINE)
    (tmp_path / "fast.yaml").write_text("kind: goal_seek\n")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path)
    registry = discover(allow=())
    (entry,) = open_planners(CampaignRequest(suites=["x"], planners=[text]), registry)
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert resolve_planner(entry.text, registry).label == entry.choice.label
    for planner in planners_by_robot(entry.text).values() or [entry.text]:
        assert planner == "dwa" or Path(planner.rpartition(":")[0] or planner).is_absolute()
