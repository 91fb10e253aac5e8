from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from crowdbot.cli import main

Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize("document", ["suite", "scenario", "planner", "part"])
def test_prints_a_schema(document: str, capsys: Captured) -> None:
    assert main(["schema", document]) == 0
    schema = json.loads(capsys.readouterr().out)
    assert schema["$id"] == f"urn:crowdbot:{document}:v1"


def test_out_writes_a_file(tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "s.json"
    assert main(["schema", "scenario", "--canonical", "--out", str(file)]) == 0
    assert capsys.readouterr().out == ""
    assert json.loads(file.read_text())["$id"] == "urn:crowdbot:scenario:canonical:v1"
    assert list(tmp_path.iterdir()) == [file]
    assert main(["schema", "suite", "--out", "/dev/null/s.json"]) == 1
    assert "cannot be written" in capsys.readouterr().err


def test_a_suite_has_no_canonical_form(capsys: Captured) -> None:
    assert main(["schema", "suite", "--canonical"]) == 2
    assert "no canonical form" in capsys.readouterr().err
    assert main(["schema", "robot"]) == 2


@pytest.mark.slow
def test_components_of_plugins_are_in_it(tmp_path: Path) -> None:
    """The schema is made from the live registry, so that a plugin's kinds complete too."""
    (tmp_path / "plugins").mkdir()
    (tmp_path / "plugins" / "acme_rooms.py").write_text(
        "from typing import Literal\n"
        "from crowdbot.dsl.spec.component import Component\n"
        "from crowdbot.plugin import EnvironmentSpec\n"
        "from crowdbot.plugin import hookimpl\n"
        "class RoomSpec(EnvironmentSpec):\n"
        '    """A room."""\n'
        "    kind: Literal['acme_rooms.room'] = 'acme_rooms.room'\n"
        "ROOM = Component(spec=RoomSpec, build='x:y', summary='a room')\n"
        "@hookimpl\n"
        "def crowdbot_components():\n"
        "    return {'environment': [ROOM]}\n",
        encoding="utf-8",
    )
    code = (
        "from pathlib import Path\n"
        "from crowdbot.core.registry.registry import discover\n"
        "from crowdbot.cli.commands.extend.schema import build\n"
        "import json\n"
        "schema = build('suite', discover(extra=[Path('plugins/acme_rooms.py')], allow=()))\n"
        "words = schema['$defs']['environment']['properties']['kind']['oneOf']\n"
        "print(json.dumps(words))\n"
    )
    argv = [sys.executable, "-c", code]
    done = subprocess.run(argv, cwd=tmp_path, capture_output=True, text=True, check=True)
    words = {w["const"]: w["description"] for w in json.loads(done.stdout)}
    assert words["acme_rooms.room"] == "A room."
    assert {"acme_rooms.room", "corridor", "floor"} <= set(words)


@pytest.mark.slow
def test_nothing_heavy_is_imported() -> None:
    code = (
        "import sys\nfrom crowdbot.cli import main\nmain(['schema', 'suite'])\n"
        "print([m for m in ('numpy', 'numba', 'pydrake') if m in sys.modules], file=sys.stderr)"
    )
    argv = [sys.executable, "-c", code]
    done = subprocess.run(argv, capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"
