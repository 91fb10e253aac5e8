"""SIGKILL at any time: what was recorded up to the last whole chunk can be had."""

from __future__ import annotations

import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.topics import Topic
from tests.cli.simulate_cases import ID, limit
from tests.cli.test_serve import _free_port
from tests.paths import ROOT

pytestmark = pytest.mark.slow
_CODE = "import sys; from crowdbot.cli import main; sys.exit(main())"
#: Drives each step, wherever the clock is.
_DRIVER = """
import json, sys
from websockets.sync.client import connect
with connect(f"ws://127.0.0.1:{sys.argv[1]}", compression=None) as c:
    c.send(json.dumps({"op": "subscribe", "topic": "/clock"}))
    for frame in c:
        c.send(json.dumps({"op": "publish", "topic": "/cmd_vel", "msg": {"linear": {"x": 0.4}}}))
"""


def _recording(out: Path) -> Path:
    """The recording, as soon as it has a chunk with samples."""
    end = time.monotonic() + 600.0
    while time.monotonic() < end:
        for path in out.glob("*/*/*/*.partial/run.mcap"):
            if path.stat().st_size > 4096 and any(r.topic == Topic.STATE for r in Records(path)):
                return path
        time.sleep(0.05)
    raise AssertionError("nothing was recorded")


@pytest.mark.parametrize("which", range(10))
@pytest.mark.parametrize("command", ["simulate", "serve"])
def test_killed_at_any_time(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str, which: int
) -> None:
    argv = [command, "challenge-2020", ID, *limit(60.0), "--out", str(tmp_path / "runs")]
    port = _free_port()
    argv += ["--port", str(port)] if command == "serve" else ["--no-references"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": ROOT}
    run = subprocess.Popen([sys.executable, "-c", _CODE, *argv], **quiet)  # type: ignore[call-overload]
    driver = None
    try:
        if command == "serve":
            end = time.monotonic() + 600.0
            while driver is None or driver.poll() is not None:  # until somebody listens
                assert time.monotonic() < end
                driver = subprocess.Popen([sys.executable, "-c", _DRIVER, str(port)], **quiet)  # type: ignore[call-overload]
                time.sleep(1.0)
        path = _recording(tmp_path / "runs")
        time.sleep(random.Random(f"{command} {which}").uniform(0.0, 2.0))
        run.send_signal(signal.SIGKILL)
        run.wait(60.0)
    finally:
        for process in (run, driver):
            if process is not None:
                process.kill()
                process.wait(60.0)
    assert cli.main(["info", str(path), "--json"]) == 0
    about = json.loads(capsys.readouterr().out)
    assert (about["finished"], about["complete"]) == (False, False)
    whole = [(r.topic, r.ns, r.data) for r in Records(path)]
    assert cli.main(["recover", str(path.parent)]) == 0
    found = path.with_name("run.recovered.mcap")
    kept = [(r.topic, r.ns, r.data) for r in Records(found)]
    assert kept[: len(whole)] == whole
    assert [topic for topic, _, _ in kept[len(whole) :]] == ["/crowdbot/end"]
    capsys.readouterr()
    assert cli.main(["info", str(found), "--json"]) == 0
    about = json.loads(capsys.readouterr().out)
    assert (about["finished"], about["complete"], about["status"]) == (True, False, "recovered")
    assert about["trajectory"]
