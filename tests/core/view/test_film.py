"""Films and pictures: what is drawn, when, how large, and in which format."""

from __future__ import annotations

import shutil
import subprocess
import sys
import types
import weakref
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from crowdbot.core.recording.placed_drawings import PlacedDrawing
from crowdbot.core.view import encode_film
from crowdbot.core.view.film import FilmedRun
from crowdbot.core.view.raster import to_image
from crowdbot.core.view.shapes import DARK, LIGHT, Disc, Drawing, Text
from crowdbot.core.view.shapes import Path as Line
from crowdbot.errors import InputError, MissingLibraryError
from tests.plugins.metrics.scenes import grid, line, scene

T = grid(4, 1 / 16)
LEGEND = 90  # px, three rows at this width


def filmed(**more: object) -> FilmedRun:
    run = scene(T, line(T, (0, 0), (1, 0)), (line(T, (3, 1), (-0.5, 0)),), goal_time=None)
    return FilmedRun(tracks=(run,), title="made up", width=320, **more)  # type: ignore[arg-type]


def near(image: Image.Image, colour: str, below: int = 0) -> np.ndarray:
    """Return x and y of the pixels of a colour, without the lowest rows."""
    wanted = np.array(Image.new("RGB", (1, 1), colour))[0, 0].astype(int)
    found = np.abs(np.asarray(image).astype(int) - wanted).max(axis=2) < 12
    return np.argwhere(found[: len(found) - below])[:, ::-1]


def test_a_legend_and_a_scale_are_below() -> None:
    (image,) = filmed().images([0.0])
    below = image.crop((0, image.height - LEGEND, *image.size))
    found = np.asarray(below).reshape(-1, 3)
    for role in ("robot", "ink"):
        wanted = np.array(Image.new("RGB", (1, 1), LIGHT[role]))[0, 0]
        assert (np.abs(found.astype(int) - wanted).max(axis=1) < 12).sum() > 20


def test_the_legend_names_what_the_planner_drew() -> None:
    drawn = PlacedDrawing(9.0, "path", np.array([[0.0, 2.0], [0.0, 0.5]]), None)  # not shown now
    for drawings, named in (((), False), (((drawn,),), True)):
        (image,) = filmed(drawings=drawings).images([0.0])
        below = image.crop((0, image.height - LEGEND, *image.size))
        assert (len(near(below, LIGHT["thought"])) > 5) == named


def test_the_robot_moves_to_the_right() -> None:
    first, last = filmed().images([0.0, 3.0])
    assert first.size == last.size
    assert first.size[0] % 2 == first.size[1] % 2 == 0
    before, after = (near(i, LIGHT["robot"], LEGEND) for i in (first, last))
    assert len(before) > 20
    assert after[:, 0].mean() > before[:, 0].mean() + 50
    assert abs(after[:, 1].mean() - before[:, 1].mean()) < 2


def test_a_robot_that_is_followed_stays_in_the_middle() -> None:
    film = filmed(follow=True, colours=DARK)
    for image in film.images([0.0, 3.0]):
        x, _ = near(image, DARK["robot"], LEGEND).mean(axis=0)
        assert x == pytest.approx(image.width / 2, abs=4)


def test_what_the_planner_draws_is_filmed_for_half_a_second() -> None:
    def drawn(name: str, *rows: tuple[float, float], texts: object = None) -> PlacedDrawing:
        return PlacedDrawing(1.0, name, np.array(rows).T, texts)  # type: ignore[arg-type]

    tracks = PlacedDrawing(1.0, "tracks", np.array([[2.0], [0.5], [0.5], [0.0]]), None)
    for one in (
        drawn("path", (0.0, 0.0), (2.0, 0.5)),
        drawn("points", (1.0, 0.5), (2.0, 0.5)),
        drawn("arrows", (1.0, 0.5), (2.0, 0.5)),
        drawn("why", (1.0, 0.5), texts=("waits",)),
        tracks,
    ):
        before, during, late = filmed(drawings=[[one]], legend=False).images([0.9, 1.4, 1.6])
        assert not len(near(before, LIGHT["thought"]))
        assert len(near(during, LIGHT["thought"])) > 10, one.name
        assert not len(near(late, LIGHT["thought"]))


def test_times_of_a_film() -> None:
    film = filmed()
    assert film.end == 4.0
    assert film.times(1.0, 2.0, 4.0, 1.0) == [1.0, 1.25, 1.5, 1.75]
    assert film.times(1.0, None, 2.0, 3.0) == [1.0, 2.5]
    for first, last in ((2.0, 1.0), (9.0, None), (-1.0, 2.0)):
        with pytest.raises(InputError, match=r"nothing to film .* the run lasts 4 s"):
            film.times(first, last, 4.0, 1.0)


def test_gif_has_all_pictures_and_colours(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    encode_film.write_gif(path, filmed().images([0.0, 1.0, 2.0]), 10.0)
    with Image.open(path) as found:
        assert found.n_frames == 3  # type: ignore[attr-defined]
        assert found.info["duration"] == 100
        assert found.info["loop"] == 0
        found.seek(2)
        assert len(near(found.convert("RGB"), LIGHT["robot"])) > 20


def test_pictures_stand_side_by_side(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    images = list(filmed().images([0.0, 2.0]))
    encode_film.write_png(path, images)
    with Image.open(path) as found:
        assert found.width == 2 * images[0].width + 8


@pytest.mark.parametrize("suffix", ["mp4", "webm"])
def test_video_has_all_pictures(tmp_path: Path, suffix: str) -> None:
    try:
        encoder = encode_film._ffmpeg()
    except MissingLibraryError:
        pytest.skip("the extra film is not installed")
    path = tmp_path / f"a.{suffix}"
    images = list(filmed().images([0.0, 1.0, 2.0]))
    encode_film.write_video(path, images, 25.0)
    head = path.read_bytes()[:64]
    assert (b"ftyp" in head) if suffix == "mp4" else head.startswith(b"\x1a\x45\xdf\xa3")
    asked = [encoder, "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(asked, capture_output=True, check=True)
    about = done.stderr.decode()
    assert f"Video: {'h264' if suffix == 'mp4' else 'vp9'}" in about
    assert "25 fps" in about
    found = np.frombuffer(done.stdout, np.uint8).reshape(3, *images[0].size[::-1], 3)
    for drawn, image in zip(found, images, strict=True):
        assert np.abs(drawn.astype(int) - np.asarray(image).astype(int)).mean() < 6.0


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_pictures_are_not_kept(tmp_path: Path, suffix: str) -> None:
    made: list[weakref.ref[Image.Image]] = []
    most = 0

    def pictures() -> Iterator[Image.Image]:
        nonlocal most
        for grey in range(30):
            image = Image.new("RGB", (64, 64), (grey, grey, grey))
            made.append(weakref.ref(image))
            most = max(most, sum(one() is not None for one in made))
            yield image

    write = encode_film.write_gif if suffix == "gif" else encode_film.write_video
    try:
        write(tmp_path / f"a.{suffix}", pictures(), 25.0)
    except MissingLibraryError:
        pytest.skip("the extra film is not installed")
    assert most < 5


def test_a_package_without_ffmpeg_for_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    def none() -> str:
        raise RuntimeError("No ffmpeg exe could be found")

    package = types.SimpleNamespace(get_ffmpeg_exe=none)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", package)
    monkeypatch.setattr(shutil, "which", lambda _: "/there/ffmpeg")
    assert encode_film._ffmpeg() == "/there/ffmpeg"


def test_what_ffmpeg_says_is_the_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\necho no codec >&2\nexit 3\n")
    fake.chmod(0o755)
    monkeypatch.setattr(encode_film, "_ffmpeg", lambda: str(fake))
    with pytest.raises(InputError, match="ffmpeg failed: no codec"):
        encode_film.write_video(tmp_path / "a.mp4", filmed().images([0.0]), 25.0)


def test_without_ffmpeg_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.raises(MissingLibraryError, match=r"crowdbot\[film\]"):
        encode_film._ffmpeg()


def test_shapes_are_clipped_and_texts_stand_above() -> None:
    shapes = (
        Disc(centre=(20.0, 20.0), radius=30.0, role="robot"),
        Line(points=((0.0, 60.0), (100.0, 60.0)), role="wall", inside=False),
        Text(at=(50.0, 90.0), text="text", role="text", anchor="middle"),
    )
    drawing = Drawing(width=100, height=100, map_box=(10, 10, 80, 40), title="", shapes=shapes)
    image = to_image(drawing)
    orange = near(image, LIGHT["robot"])
    assert orange.min(axis=0).tolist() >= [10, 10]
    assert orange[:, 1].max() < 50
    assert near(image, LIGHT["wall"])[:, 0].min() == 0
    assert len(near(image, LIGHT["ink"])) > 5


def test_options_of_other_formats_are_refused(tmp_path: Path) -> None:
    from crowdbot import cli

    (tmp_path / "run.mcap").write_bytes(b"")
    for argv in (
        ["--to", "csv", "--dark"],
        ["--to", "png", "--from", "1"],
        ["--to", "gif", "--at", "1"],
        ["--to", "mp4", "--out", str(tmp_path / "a.avi")],
        ["--to", "png", "--out", str(tmp_path / "picture")],
    ):
        assert cli.main(["export", str(tmp_path / "run.mcap"), *argv]) == 2
