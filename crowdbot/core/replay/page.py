"""Writes the replay page.

The page is one file that asks the network for nothing: a content security policy allows the one
style sheet and the one script in it, by hash, and no more.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from crowdbot.core.aside import write_aside
from crowdbot.core.replay.encode import encode, summary
from crowdbot.core.replay.scan import ReplayScan
from crowdbot.core.replay.scores import grouped
from crowdbot.core.score import Score
from crowdbot.core.trajectory import Trajectories

_SCRIPTS = ("decode.js", "motion.js", "draw.js", "timeline.js", "app.js")


def write_replay(
    path: Path,
    run: Trajectories,
    scans: Sequence[ReplayScan],
    scores: Sequence[Score],
    title: str,
    facts: Mapping[str, str],
) -> None:
    """Write one offline HTML page; equal input gives equal bytes.

    Args:
        path: file to write, aside first and then renamed.
        run: what to show; a run without robot or without people is fine.
        scans: what lidars saw; drawn from the robot's true pose.
        scores: shown beside the run; may be empty.
        title: heading, e.g. the scenario's id.
        facts: name -> text; ``Status`` is shown beside the title.

    Raises:
        InputError: the path cannot be written.
    """
    text = _render(run, scans, scores, title, facts)
    write_aside(path, text)


def _render(
    run: Trajectories,
    scans: Sequence[ReplayScan],
    scores: Sequence[Score],
    title: str,
    facts: Mapping[str, str],
) -> str:
    meta, blobs = encode(run, scans)
    style, script = _asset("page.css"), "\n".join(_asset(name) for name in _SCRIPTS)
    status = next((v for k, v in facts.items() if k.lower() == "status"), "")
    template = _environment().from_string(_asset("page.html.j2"))
    return template.render(
        title=title,
        status=status,
        facts={k: v for k, v in facts.items() if k.lower() != "status"} | dict(summary(run)),
        groups=grouped(scores),
        meta=meta,
        blobs=blobs,
        policy=_policy(style, script),
        style=Markup(style),
        script=Markup(script),
    )


def _policy(style: str, script: str) -> str:
    parts = {
        "default-src": "'none'",
        "script-src": _hash(script),
        "style-src": _hash(style),
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    return "; ".join(f"{k} {v}" for k, v in parts.items())


def _hash(text: str) -> str:
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
    return f"'sha256-{digest}'"


def _asset(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _environment() -> jinja2.Environment:
    options: dict[str, Any] = {"trim_blocks": True, "lstrip_blocks": True}
    return jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, **options)
