"""Bags of recordings that ended badly: what is whole is read, the rest is refused with a remedy."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin

from crowdbot.core.trajectories.bag import reader
from crowdbot.errors import InputError
from tests.core.trajectories.bag.bag_kit import check_walkers, marker_rows, read, robot_rows, write


def _bag(folder: Path, plugin: StoragePlugin = StoragePlugin.SQLITE3) -> Path:
    bag = write(folder / "bag", [*robot_rows(), *marker_rows()], plugin)
    (bag / "metadata.yaml").unlink()  # written at the end, so lost with the power
    return bag


def _split(bag: Path) -> None:
    """Divide the messages among parts 2 and 10."""
    whole = (bag / "bag.db3").read_bytes()
    for name, first, last in (("bag_2.db3", 0, 30), ("bag_10.db3", 31, 10**6)):
        (bag / name).write_bytes(whole)
        with sqlite3.connect(bag / name) as part:
            part.execute("delete from messages where id not between ? and ?", (first, last))
        part.close()
    (bag / "bag.db3").unlink()


@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_folder_without_metadata_is_read(tmp_path: Path, plugin: StoragePlugin) -> None:
    check_walkers(read(_bag(tmp_path, plugin)))


def test_parts_without_metadata_are_one_recording(tmp_path: Path) -> None:
    bag = _bag(tmp_path)
    _split(bag)
    check_walkers(read(bag))


def _cut(bag: Path) -> None:
    file = next(bag.iterdir())
    file.write_bytes(file.read_bytes()[:-400])


def _packed(bag: Path) -> None:
    (bag / "bag.db3").rename(bag / "bag.db3.zstd")


def _older(bag: Path) -> None:
    with sqlite3.connect(bag / "bag.db3") as made:
        made.execute("alter table topics drop column offered_qos_profiles")
    made.close()


def _other(bag: Path) -> None:
    (bag / "bag.db3").write_bytes(b"hello" * 100)


def _none(bag: Path) -> None:
    (bag / "bag.db3").unlink()


@pytest.mark.parametrize(
    ("plugin", "damage", "told"),
    [
        (StoragePlugin.MCAP, _cut, "mcap recover FILE"),
        (StoragePlugin.SQLITE3, _cut, r"cut off: .* 'sqlite3 FILE .recover"),
        (StoragePlugin.SQLITE3, _packed, "unpack it with 'zstd -d FILE'"),
        (StoragePlugin.SQLITE3, _older, "'ros2 bag convert' renews it"),
        (StoragePlugin.SQLITE3, _other, "file is not a database"),
        (
            StoragePlugin.SQLITE3,
            _none,
            "a folder without metadata.yaml, .mcap, .db3 and .bag files",
        ),
    ],
)
def test_what_cannot_be_read_is_refused_with_what_helps(
    tmp_path: Path, plugin: StoragePlugin, damage: Callable[[Path], None], told: str
) -> None:
    bag = _bag(tmp_path, plugin)
    damage(bag)
    with pytest.raises(InputError, match=told):
        read(bag)


def _our_fault(*_: object) -> None:
    raise KeyError("a fault of ours")


@pytest.mark.parametrize("ours", ["definitions.known_types", "reader._remedy", "reader._parts"])
def test_faults_of_ours_are_not_told_as_the_bags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ours: str
) -> None:
    bag = _bag(tmp_path)
    _other(bag)
    monkeypatch.setattr(f"crowdbot.core.trajectories.bag.{ours}", _our_fault)
    with pytest.raises(KeyError, match="a fault of ours"):
        read(bag)


def test_faults_while_a_bag_is_open_keep_their_type(tmp_path: Path) -> None:
    bag = _bag(tmp_path)
    with pytest.raises(ZeroDivisionError), reader._opened(bag):
        raise ZeroDivisionError


def test_what_the_library_finds_amid_a_bag_is_the_bags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> Iterator[tuple[object, int, bytes]]:
        raise IndexError("row 3")
        yield None, 0, b""

    bag = _bag(tmp_path)
    monkeypatch.setattr("rosbags.highlevel.AnyReader.messages", broken)
    with pytest.raises(InputError, match="not a bag that can be read: row 3"):
        read(bag)
