"""three.js in the pages: it is what the pinned package makes, and the policy knows it."""

from __future__ import annotations

import base64
import hashlib
import shutil
import subprocess
import zlib
from pathlib import Path

import pytest

from crowdbot.core.live.person.page import render_person_page
from crowdbot.core.replay.page import write_replay
from crowdbot.core.replay.three import three_packed, three_source
from tests.core.replay.replay_cases import passing
from tests.paths import ROOT

ESBUILD = ROOT / "scripts/js/node_modules/esbuild"


def _hash(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def test_pages_carry_it_packed_and_their_policy_allows_nothing_else(tmp_path: Path) -> None:
    source = three_source()
    assert zlib.decompress(base64.b64decode(three_packed())).decode() == source
    assert "@license" in source
    assert "</script" not in source
    assert len(three_packed()) < 200_000
    write_replay(tmp_path / "replay.html", passing())
    for page in (
        (tmp_path / "replay.html").read_text(encoding="utf-8"),
        render_person_page("drive", "<scenario>"),
        render_person_page("walk", "x"),
    ):
        policy = page.partition("Content-Security-Policy")[2].partition(">")[0]
        assert f"&#39;sha256-{_hash(source)}&#39;" in policy or _hash(source) in policy
        assert "unsafe" not in policy
        assert "blob:" not in policy.partition("script-src")[2].partition(";")[0]
        assert three_packed() in page
        assert "<scenario>" not in page


@pytest.mark.skipif(
    not (ESBUILD.is_dir() and shutil.which("node")), reason="no esbuild: make check-js"
)
def test_it_is_made_from_the_pinned_package(tmp_path: Path) -> None:
    made = tmp_path / "three.min.js"
    script = ROOT / "scripts/js/three/bundle.mjs"
    subprocess.run(["node", str(script), str(made)], check=True, timeout=120)
    assert made.read_text(encoding="utf-8") == three_source()
