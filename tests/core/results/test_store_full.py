"""An index on a full disk, or in a folder that is too deep."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.results.store import index
from crowdbot.errors import InputError


def test_a_full_disk_is_told_and_the_index_goes_on_later(tmp_path: Path) -> None:
    with index(tmp_path) as store:
        store._database.execute("PRAGMA max_page_count = 1")
        with pytest.raises(InputError, match="no space left on device"), store._writing():
            store._database.execute("CREATE TABLE more AS SELECT randomblob(1000000) AS a")
    with index(tmp_path) as store:
        store.synchronise()
        assert store.rows().runs == ()


def test_a_path_that_sqlite_does_not_take_is_told(tmp_path: Path) -> None:
    deep = tmp_path.joinpath(*["d" * 200] * 3)
    with pytest.raises(InputError, match="SQLite takes 504: choose a shorter folder"), index(deep):
        pass
    room = 504 - len(str(tmp_path)) - len("//results.sqlite") - 200
    near = tmp_path / ("d" * 200) / ("e" * (room - 1))
    with index(near) as store:
        store.synchronise()
    assert len(str(near / "results.sqlite")) == 504
