"""Add the facts of a live run to its record."""

from __future__ import annotations

from dataclasses import replace

from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.record_parts import LivePart
from crowdbot.core.runs.run import Run


def with_live_part(run: Run, live: LivePart) -> Run:
    """Write the live part into run.json, and return the run with it."""
    record = run.record.model_copy(update={"live": live})
    files.attach_files(run.directory, record.document())
    listed = {"files": files.sizes(run.directory), "digests": files.digests(run.directory)}
    record = record.model_copy(update=listed)
    record.write(run.directory)
    return replace(run, record=record)
