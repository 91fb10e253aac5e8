"""Lets the readers of others read every message of a recording, and counts.

    .venv/bin/python scripts/recording_readers.py RUN_DIR [--modules FOLDER] [--rosbag PYTHON]

rosbags and mcap-ros2-support read `run.mcap`; rosbags also reads the folder that `crowdbot export
--to rosbag2` makes of it. With node and `npm install` in scripts/js/viewer, @mcap/core with
@foxglove/rosmsg2-serialization does, too. Debian's rosbag (package python3-rosbag) reads what
`--to rosbag1` makes. A reader that is not installed is named. Ends with 1 where one reads another
number of messages of any topic than the others of the same file.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

ROOT = Path(__file__).parent.parent
VIEWER = ROOT / "scripts/js/viewer"
ROSBAG = """
import collections, json, rosbag, sys
with rosbag.Bag(sys.argv[1]) as bag:
    messages = [(topic, message) for topic, message, _ in bag.read_messages()]
print(json.dumps(collections.Counter(topic for topic, _ in messages)))
"""


def main() -> int:
    """One line for each reader; whether they agree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("run", type=Path)
    parser.add_argument("--modules", type=Path, default=VIEWER / "node_modules")
    parser.add_argument("--rosbag", default="/usr/bin/python3", help="Python that has rosbag")
    chosen = parser.parse_args()
    recording = chosen.run / "run.mcap"
    with tempfile.TemporaryDirectory() as name:
        bags = {to: _exported(chosen.run, to, Path(name)) for to in ("rosbag2", "rosbag1")}
        node = [shutil.which("node") or "node", str(VIEWER / "count.mjs")]
        same = _agree(
            recording.name,
            {
                "rosbags": lambda: _rosbags(recording),
                "mcap-ros2-support": lambda: _mcap_ros2(recording),
                "@mcap/core": lambda: _told([*node, str(chosen.modules.resolve()), str(recording)]),
            },
        )
        same &= _agree("as rosbag2", {"rosbags": lambda: _rosbags(bags["rosbag2"])})
        rosbag = [chosen.rosbag, "-c", ROSBAG, str(bags["rosbag1"])]
        readers = {"rosbags": lambda: _rosbags(bags["rosbag1"]), "rosbag": lambda: _told(rosbag)}
        same &= _agree("as rosbag1", readers)
    return int(not same)


def _agree(what: str, readers: dict[str, Callable[[], Counter[str]]]) -> bool:
    found = []
    for name, read in readers.items():
        try:
            found.append(read())
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"{what:12} {name:20} not there: {error}")
            continue
        print(f"{what:12} {name:20} {found[-1].total():7} messages, {len(found[-1])} topics")
    return all(counts == found[0] for counts in found)


def _exported(run: Path, to: str, folder: Path) -> Path:
    out = folder / (f"{to}.bag" if to == "rosbag1" else to)
    argv = ["export", str(run), "--to", to, "--out", str(out)]
    subprocess.run([sys.executable, "-m", "crowdbot", *argv], check=True, capture_output=True)
    return out


def _rosbags(path: Path) -> Counter[str]:
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        found: Counter[str] = Counter()
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
            found[connection.topic] += 1
    return found


def _mcap_ros2(path: Path) -> Counter[str]:
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        messages = reader.iter_decoded_messages()
        return Counter(m.channel.topic for m in messages if m.decoded_message is not None)


def _told(argv: list[str]) -> Counter[str]:
    done = subprocess.run(argv, check=True, capture_output=True, text=True)
    return Counter(json.loads(done.stdout))


if __name__ == "__main__":
    sys.exit(main())
