"""An index on a full disk."""

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
