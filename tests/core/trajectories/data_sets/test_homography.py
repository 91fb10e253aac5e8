"""Positions in pixels and times in frames: on the commands that read tables of others."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.cli import main
from crowdbot.core.realism.recordings import read_tracks
from crowdbot.core.trajectories.data_sets.homography import VideoScale, matrix_of, video_scale
from crowdbot.errors import InputError

MATRIX = "# pixels to metres\n0.02 0.001 3\n-0.002, 0.021, 7\n0 0.0001 1\n"
WRONG = {
    "0.02 0 0\n0 abc 0\n0 0 1\n": ":2: 'abc' is not a finite number",
    "0.02 0 0\n0 nan 0\n0 0 1\n": ":2: 'nan' is not a finite number",
    "0.02 0 0\n# a comment\n0 0.02\n0 0 1\n": ":3: 2 numbers, not 3",
    "0.02 0 0\n0 0.02 0\n": ":2: 2 rows",
    "0.02 0 0\n0 0.02 0\n0 0 1\n\n0 0 0\n": ":5: 4 rows",
    "0.02 0.01 5\n0.04 0.02 10\n0 0 1\n": ":2: the matrix is singular",
    "0.02 0 100\n0.1 0.3 200\n0.36 0.9 900\n": ":3: the matrix is singular",
    "0 0 0\n0 1 0\n0 0 1\n": ":1: the matrix is singular",
    "# nothing\n": ": no line has numbers",
}


def _file(folder: Path, text: str, name: str = "H.txt") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def _walks(folder: Path, matrix: np.ndarray | None, head: str = "frame,id,x,y") -> Path:
    """Two streams of people along a corridor, 25 frames a second; in pixels with a matrix."""
    lines = [head]
    for frame in range(0, 1500, 5):
        for person in range(14):
            sign = 1.0 if person % 2 else -1.0
            place = [sign * (-8.0 + 0.04 * frame - 3.0 * (person // 2)), 0.45 * person, 1.0]
            if abs(place[0]) > 9.0:
                continue
            if matrix is not None:
                place = list(np.linalg.solve(matrix, place))
            lines.append(f"{frame},{person},{place[0] / place[2]:.12g},{place[1] / place[2]:.12g}")
    return _file(folder, "\n".join(lines) + "\n", "tracks.csv")


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_in_a_file_is_told_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str
) -> None:
    path = _file(tmp_path, text)
    with pytest.raises(InputError) as error:
        matrix_of(path)
    assert f"{path}{WRONG[text]}" in str(error.value)
    assert main(["realism", "rvo", "--reference", "a.csv", "--homography", str(path)]) == 1
    assert WRONG[text].partition(" ")[0] in capsys.readouterr().err


@pytest.mark.parametrize("given", ["0", "-0.02", "nan", "inf", "none.txt"])
def test_numbers_and_files_that_are_no_homography(given: str) -> None:
    with pytest.raises(InputError, match=r"metres per pixel|no such file|No such file"):
        video_scale(given, None)


def test_an_invertible_matrix_of_very_unlike_numbers_is_taken(tmp_path: Path) -> None:
    text = "2e-5 1e-6 -40\n1e-6 3e-5 12\n1e-9 2e-9 1\n"
    assert matrix_of(_file(tmp_path, text))[0, 2] == -40.0


def test_a_table_in_pixels_and_frames_is_that_in_metres(tmp_path: Path) -> None:
    scale = video_scale(str(_file(tmp_path, MATRIX)), 25.0)
    assert scale.homography is not None
    pixels = read_tracks(_walks(tmp_path, np.array(scale.homography)), scale)
    metres = read_tracks(_walks(tmp_path, None), VideoScale(None, 25.0))
    np.testing.assert_allclose(pixels.position, metres.position, atol=1e-6)
    run = crowdbot.Trajectories.from_csv(
        agents=_walks(tmp_path, np.array(scale.homography)), frame_rate=25.0,
        homography=tmp_path / "H.txt",
    )  # fmt: skip
    assert run.agents is not None
    assert np.nanmax(np.abs(np.diff(run.agents.x, axis=0))) == pytest.approx(0.2)


def test_bags_have_metres_and_seconds(tmp_path: Path) -> None:
    bag = _file(tmp_path, "", "people.bag")
    with pytest.raises(InputError, match=r"people\.bag: has metres and seconds"):
        read_tracks(bag, VideoScale(None, 25.0))


def test_commands_take_the_scale(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    matrix = _file(tmp_path, MATRIX)
    tracks = _walks(tmp_path, matrix_of(matrix))
    assert main(["import", str(tracks), "--out", "a.yaml"]) == 1
    assert "tracks.csv:2: times are numbers of frames" in capsys.readouterr().err
    scale = ["--homography", str(matrix), "--frame-rate", "25"]
    assert main(["import", str(tracks), "--out", "a.yaml", *scale]) == 0
    rows = np.loadtxt(tmp_path / "a.recorded.csv", delimiter=",", skiprows=1)
    assert rows[:, 0].max() == pytest.approx(35.0)
    assert np.abs(rows[:, 2]).max() == pytest.approx(9.0, abs=1e-6)
    assert main(["realism", "human", "--robot", "--reference", "a.csv", *scale]) == 2
    assert "have metres and seconds" in capsys.readouterr().err
    assert main(["realism", "rvo", "--frame-rate", "25"]) == 2
    assert "are for the files of --reference" in capsys.readouterr().err
    assert main(["realism", "rvo", "--reference", str(tracks), "--frame-rate", "0"]) == 1
    assert "a frame rate is a number of frames per second, not 0" in capsys.readouterr().err
    other = _file(tmp_path, "<Simulation><World/></Simulation>", "u.xml")
    assert main(["import", str(other), *scale]) in (1, 2)
