"""Tracks of people from files, in the formats that `Trajectories` reads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from crowdbot.core.realism.tracks import CorridorTracks, of_files, tracks_of
from crowdbot.core.recording.recording import Recording
from crowdbot.core.trajectories.bag.tables import people_topics
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale
from crowdbot.core.trajectories.data_sets.people_files import ENDINGS, people_run, people_table
from crowdbot.core.trajectories.table_columns.completed import sentences
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.dsl.text.bounded_files import open_file
from crowdbot.errors import InputError

#: Separator between a bag and a topic in it.
_TOPIC = ":/"
_BAGS = (".bag", ".db3")
#: Bytes before the first text of a container (mcap.dev/spec): magic, opcode and length; and its
#: start.
_HEAD, _LONGEST = 8 + 1 + 8, 1000
_FORMATS = (
    "a recording (.mcap), a table t,id,x,y (.csv, .tsv), a bag of ROS (.bag, .db3, .mcap, or a "
    "folder with metadata.yaml), TrajNet++ (.ndjson), ETH and UCY (.txt, .vsp), or JuPedSim (.txt, "
    ".sqlite)"
)


def read_tracks(path: Path, scale: VideoScale = AS_STATED) -> CorridorTracks:
    """Read tracks from a recording, a table of people, a ROS bag, or a data set's file.

    Args:
        path: the file; for a bag with several topics of people, ``BAG:/TOPIC``.
        scale: of tables and data sets; others have metres and seconds.

    Raises:
        InputError: it cannot be read, or is of another format.
        UnknownNameError: a bag has no such topic.
    """
    table = path.suffix.lower() in ENDINGS
    if scale and not table and (path.exists() or _TOPIC in str(path)):
        raise InputError(
            f"{path}: has metres and seconds; a homography and a frame rate are for tables and "
            f"data sets ({', '.join(ENDINGS)})"
        )
    if not path.exists() and _TOPIC in str(path):
        bag, _, topic = str(path).partition(_TOPIC)
        return tracks_of(_bag(Path(bag), f"/{topic}"), str(path))
    if not path.exists():
        raise InputError(f"{path}: no such file")
    if path.is_dir():
        if (path / "metadata.yaml").is_file():
            return tracks_of(_bag(path), str(path))
        raise InputError(f"{path}: a folder, but not a bag of ROS: it has no metadata.yaml")
    if table:
        people = people_table(path, scale)
        return tracks_of(people_run(people, sentences(people)), str(path))
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: not {_FORMATS}")
    return tracks_of(reader(path), str(path))


def read_runs(files: Sequence[Path]) -> tuple[list[CorridorTracks], list[str]]:
    """Return tracks of finished runs, and why others are left out: no people, or too short.

    Raises:
        InputError: a recording cannot be read, or all are left out.
    """
    return of_files(files, lambda file: [tracks_of(_run(file), str(file))])


def _bag(path: Path, topic: str | None = None) -> Trajectories:
    """Return the people of a bag: from the named topic, or from the only one with people."""
    if topic is None:
        topics = people_topics(path)
        if len(topics) != 1:
            seen = f"people are in {', '.join(topics)}" if topics else "no topic holds people"
            raise InputError(f"{path}: which topic? Write {path}{_TOPIC}TOPIC; {seen}")
        topic = topics[0]
    return Trajectories.from_rosbag(path, people=topic)


def _recording(path: Path) -> Trajectories:
    """Read a crowdbot recording, or a ROS bag in the same container."""
    profile, library = _origin(path)
    if profile.startswith("ros") and library != "crowdbot":
        return _bag(path)
    return _run(path)


def _run(path: Path) -> Trajectories:
    """Read a crowdbot recording.

    For several robots, the run of the last to end, which meets all people.
    """
    with Recording(path) as recording:
        runs = [recording.trajectories(name) for name in recording.robots or (None,)]
    return max(runs, key=lambda run: float(run.t[-1]))


def _origin(path: Path) -> tuple[str, str]:
    """Return profile and library from a container's first record; empty if missing."""
    with open_file(path) as file:
        head = file.read(_LONGEST)
    at, found = _HEAD, []
    for _ in range(2):
        length = int.from_bytes(head[at : at + 4], "little")
        found.append(head[at + 4 : at + 4 + length].decode("utf-8", errors="replace"))
        at += 4 + length
    return found[0], found[1]


_READERS: Mapping[str, Callable[[Path], Trajectories]] = {
    ".mcap": _recording,
    **dict.fromkeys(_BAGS, _bag),
}
