"""Locks, also on a file system that has none."""

from __future__ import annotations

import errno
import fcntl
import os
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.results.store import index
from crowdbot.core.runs.run_directory import partial
from crowdbot.core.support import locks
from crowdbot.errors import InputError


@pytest.fixture(params=[errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP])
def _without(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file system has no locks."""

    def flock(*_: Any) -> None:
        raise OSError(request.param, os.strerror(request.param))

    monkeypatch.setattr(fcntl, "flock", flock)
    locks._warn.cache_clear()


@pytest.mark.usefixtures("_without")
def test_work_goes_on_without_locks(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    final = tmp_path / "run"
    with partial(final) as one, partial(final) as other:
        assert one != other  # each has a folder of its own
        (one / "a").write_text("a")
    for _ in range(2):
        with index(tmp_path) as store:
            store.synchronise()
            assert store.rows().runs == ()
    assert caplog.text.count("has no locks") == 1


def test_another_error_of_a_lock_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def flock(*_: Any) -> None:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(fcntl, "flock", flock)
    with pytest.raises(InputError, match="cannot be locked: Input/output error"), index(tmp_path):
        pass


def test_only_one_process_writes_an_index(tmp_path: Path) -> None:
    with index(tmp_path), pytest.raises(InputError, match="another campaign"), index(tmp_path):
        pass
