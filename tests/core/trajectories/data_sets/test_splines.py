"""People of UCY in splines, whose control points are pixels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.core.realism.recordings import read_tracks
from crowdbot.errors import InputError, RecordingWarning

READ = crowdbot.Trajectories
#: Two people: one crosses the picture, with a corner; one is there for less than an annotation.
PIXELS = """2 - the number of splines
3 - Num of control points
-300.000000 -50.000000 5 87.39 - (2D point, m_id)
0.000000 -50.000000 105 87.39 - (2D point, m_id)
0.000000 150.000000 145 -90.0 - (2D point, m_id)
2 - Num of control points
10 10 12 0.0 - (2D point, m_id)
11 10 15 0.0 - (2D point, m_id)
"""


def _written(folder: Path, text: str = PIXELS) -> Path:
    (folder / "crowds.vsp").write_text(text)
    return folder / "crowds.vsp"


def test_pixels_need_a_homography(tmp_path: Path) -> None:
    path = _written(tmp_path)
    with pytest.raises(InputError, match=r"are pixels \(people move by 75 a second.*H\.txt"):
        READ.from_eth_ucy(path)
    with pytest.raises(InputError, match="are pixels"):
        read_tracks(path)
    with pytest.raises(InputError, match=r"splines of UCY.*from_eth_ucy"):
        READ.from_csv(agents=path)


def test_places_between_control_points(tmp_path: Path) -> None:
    with pytest.warns(RecordingWarning, match="1 of 2 people are there for less than 10 frames"):
        run = READ.from_eth_ucy(_written(tmp_path), homography=0.02)
    assert run.agents is not None
    assert run.agents.id.tolist() == [0]
    frames = np.arange(10, 150, 10)
    np.testing.assert_allclose(run.t, (frames - 10) / 25.0)
    x = np.interp(frames, [5, 105, 145], [-6.0, 0.0, 0.0])
    y = np.interp(frames, [5, 105, 145], [-1.0, -1.0, 3.0])
    np.testing.assert_allclose(run.agents.x[:, 0], x, atol=1e-12)
    np.testing.assert_allclose(run.agents.y[:, 0], y, atol=1e-12)


def test_a_matrix_of_numbers_or_in_a_file(tmp_path: Path) -> None:
    path, matrix = _written(tmp_path), [[0.02, 0.0, 7.0], [0.0, 0.03, 1.0], [0.0, 0.001, 1.0]]
    with pytest.warns(RecordingWarning, match="less than 10"):
        run = READ.from_eth_ucy(path, homography=matrix)
    assert run.agents is not None
    assert run.agents.x[0, 0] == pytest.approx((0.02 * -285.0 + 7.0) / 0.95, abs=0.02)
    file = tmp_path / "H.txt"
    file.write_text("\n".join(" ".join(map(str, row)) for row in matrix))
    with pytest.warns(RecordingWarning, match="less than 10"):
        named = READ.from_eth_ucy(path, homography=file)
    with pytest.warns(RecordingWarning) as warned:
        beside = READ.from_eth_ucy(path)
    assert "become metres by H.txt beside it" in str(warned[0].message)
    for other in (named, beside):
        assert other.agents is not None
        np.testing.assert_array_equal(other.agents.x, run.agents.x)


@pytest.mark.parametrize("homography", [np.eye(2), "crowds.vsp", np.zeros((3, 3)), float("nan")])
def test_what_is_no_homography(tmp_path: Path, homography: object) -> None:
    path = _written(tmp_path)
    given = tmp_path / homography if isinstance(homography, str) else homography
    with pytest.raises(InputError, match="an invertible matrix of 3 x 3"):
        READ.from_eth_ucy(path, homography=given)  # type: ignore[arg-type]


def test_metres_are_noticed(tmp_path: Path) -> None:
    text = "1 - the number of splines\n2\n-18.5 -3.8 0 148.7\n-14.3 -3.8 83 119.1\n"
    with pytest.warns(RecordingWarning, match=r"taken for metres: people walk at 1.3 m/s"):
        run = READ.from_eth_ucy(_written(tmp_path, text))
    assert run.agents is not None
    assert run.agents.x[0, 0] == -18.5


def test_rows_in_pixels(tmp_path: Path) -> None:
    rows = tmp_path / "obsmat_px.txt"
    rows.write_text("".join(f"{f} 7 {3.0 * f} 0 430 0 0 0\n" for f in range(1, 41, 10)))
    with pytest.warns(RecordingWarning) as warned:
        READ.from_eth_ucy(rows)
    assert "people move by 75 a second (median): pixels? homography" in str(warned[0].message)
    run = READ.from_eth_ucy(rows, homography=0.02)
    assert run.agents is not None
    np.testing.assert_allclose(run.agents.x[:, 0], 0.06 * np.arange(1, 41, 10))
    np.testing.assert_allclose(run.agents.y, 8.6)
    boxes = tmp_path / "annotations.txt"
    boxes.write_text('0 892 1265 932 1304 0 0 0 0 "Biker"\n0 892 1265 932 1304 1 0 0 1 "Biker"\n')
    with pytest.raises(InputError, match=r"txt:1: .*Stanford Drone Dataset.*boxes in pixels"):
        READ.from_eth_ucy(boxes)
    boxes.write_text("1,1,794.27,247.59,71.245,174.88,-1,-1,-1,-1\n")
    with pytest.raises(InputError, match=r"MOTChallenge.*top \+ height; .*homography"):
        READ.from_eth_ucy(boxes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("many - the number of splines\n", r":1: 'many' is not the number of splines"),
        ("1\n2 3\n1 2 3 4\n", r":2: '2 3' is not the number of control points of spline 1"),
        ("1\n2\n1 2 3 4\n", "ends in spline 1 of 1, at control point 1 of 2"),
        ("2\n1\n1 2 3 4\n", "ends where the number of control points of spline 2"),
        ("1\n1\n1 2 x 4\n", r":3: could not convert .* x y frame gaze are wanted"),
        ("1\n1\n1 2\n", ":3: x y frame gaze are wanted, not 1 2"),
        ("1\n1\n1 2 nan 4\n", ":3: x y frame gaze are wanted"),
        ("0 - the number of splines\n", "no one is there"),
        ("1\n2\n0 0 0 0\n1 1 1e15 0\n", r"spline 1 lasts from frame 0 to 1e\+15"),
    ],
)
def test_damaged_files_are_refused_at_their_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        READ.from_eth_ucy(_written(tmp_path, text), homography=1.0)
