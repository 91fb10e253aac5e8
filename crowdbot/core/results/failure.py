"""Records of failed runs: one file each, beside the directory that the run would have."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path

from crowdbot.core.runs.run_directory import write_json
from crowdbot.core.support.text_files import read_text

SUFFIX = ".failure.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A run that a campaign could not make, with its error message, as stored in a file.

    Attributes:
        suite: as in `RunRow`: failures of altered scenarios are a suite of their own.
        axes, position: as in `RunRecord`.
        exit_code: what `crowdbot simulate` would have ended with.
    """

    run_id: str = ""
    suite: str
    scenario: str
    planner: str
    seed: int
    position: int = 0
    error: str
    traceback: str
    exit_code: int = 0
    axes: Mapping[str, str] = field(default_factory=dict)


def write_failure(run: Path, failure: Failure) -> None:
    """Write the failure beside the run's directory, which need not exist.

    Raises:
        InputError: it cannot be written.
    """
    run.parent.mkdir(parents=True, exist_ok=True)
    write_json(_file(run), asdict(failure))


def read_failure(file: Path) -> Failure | None:
    """Read a failure; return None for anything else."""
    try:
        content = json.loads(read_text(file))
        content.setdefault("axes", {})  # missing in records of earlier versions
        return Failure(**{f.name: content[f.name] for f in fields(Failure)})
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def forget_failure(run: Path) -> None:
    """Delete the failure of a run that now exists."""
    with suppress(FileNotFoundError):
        _file(run).unlink()


def _file(run: Path) -> Path:
    return run.with_name(run.name + SUFFIX)
