"""Collision meshes become boxes, hulls or convex pieces; descriptions hold them without files."""

from __future__ import annotations

from importlib import util
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from pydrake.systems.framework import DiagramBuilder

from crowdbot.core.robots import mesh_pieces as pieces
from crowdbot.core.robots.convex_piece import corners_of
from crowdbot.core.robots.description import Description
from crowdbot.core.robots.published import read_published
from crowdbot.core.robots.published_conversion import PublishedWheel
from crowdbot.core.robots.simplify import simplified
from crowdbot.core.sim.plant import add_plant
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.robot import HolonomicDrive, RobotLimits, RobotModel
from crowdbot.errors import PluginError

#: Corners of an L in the x-z plane, 1 m wide and high, with legs 0.3 m thick.
_L = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.3), (0.3, 0.3), (0.3, 1.0), (0.0, 1.0)]
_URDF = """\
<robot name="crane">
  <link name="base_link">
    <inertial><mass value="10"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.2"/><geometry><mesh filename="arm.obj" scale="0.5 0.5 0.5"/>
    </geometry></collision>
  </link>
</robot>
"""


def _prism(path: Path, corners: list[tuple[float, float]] = _L) -> None:
    """Write an OBJ: an outline in the x-z plane, 0.2 m deep, its caps as fans and strips."""
    lines = [f"v {x} {y} {z}" for y in (-0.1, 0.1) for x, z in corners]
    count = len(corners)
    caps = [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 6)] if corners is _L else []
    for a, b, c in caps:
        lines += [f"f {a} {b} {c}", f"f {a + count} {c + count} {b + count}"]
    for k in range(count):
        a, b = k + 1, (k + 1) % count + 1
        lines += [f"f {a} {a + count} {b}", f"f {b} {a + count} {b + count}"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _described(folder: Path, shape: pieces.MeshShape) -> Description:
    _prism(folder / "arm.obj")
    (folder / "crane.urdf").write_text(_URDF, encoding="utf-8")
    return read_published(folder / "crane.urdf", wheels={}, shell="", meshes=shape)


def _hidden(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    real = util.find_spec
    monkeypatch.setattr(util, "find_spec", lambda name: None if name in names else real(name))


def test_a_hull_is_in_the_text_and_needs_no_file(tmp_path: Path) -> None:
    described = _described(tmp_path, "hulls")
    assert "collision mesh becomes its convex hull: base_link" in described.notes
    (shape,) = described.link("base_link").findall("collision/geometry/mesh")
    corners = corners_of(shape)
    assert len(corners) == 10  # the inner corner of the L is not on its hull
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.5, 0.1, 0.5])
    assert str(tmp_path) not in described.text
    _, (piece,) = simplified(described, ())
    np.testing.assert_allclose(piece.corners[:, 2].min(), 0.2)


def test_without_coacd_pieces_are_a_hull_and_the_note_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _hidden(monkeypatch, "coacd")
    described = _described(tmp_path, "pieces")
    (note,) = [n for n in described.notes if "mesh" in n]
    assert "convex hull instead of pieces: base_link (coacd" in note
    assert "not installed" in note
    assert "pip install 'crowdbot[meshes]'" in note
    assert len(described.link("base_link").findall("collision")) == 1


def test_corners_are_bounded_and_the_hull_never_grows() -> None:
    rng = np.random.default_rng(1)
    points = rng.normal(size=(5000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    hull = pieces.bounded_hull(points)
    assert hull is not None
    assert 40 <= len(hull) <= pieces.MOST_CORNERS
    np.testing.assert_allclose(np.linalg.norm(hull, axis=1), 1.0, atol=1e-5)
    flat = np.column_stack([points[:, :2], np.zeros(len(points))])
    assert pieces.bounded_hull(flat) is None
    assert pieces.bounded_hull(points[:3]) is None


def test_a_flat_or_unknown_mesh_becomes_a_box_or_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "arm.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    (tmp_path / "crane.urdf").write_text(_URDF, encoding="utf-8")
    described = read_published(tmp_path / "crane.urdf", wheels={}, shell="", meshes="hulls")
    assert "collision mesh becomes the box around it: base_link" in described.notes
    (tmp_path / "arm.obj").write_text("nothing\n", encoding="utf-8")
    described = read_published(tmp_path / "crane.urdf", wheels={}, shell="", meshes="hulls")
    assert any("neither STL nor OBJ" in note for note in described.notes)


def test_drake_collides_with_the_pieces(tmp_path: Path) -> None:
    described = _described(tmp_path, "hulls")
    robot = RobotModel(
        description=described.text, base="base_link", base_height=0.1,
        drive=HolonomicDrive(max_force=10.0, max_torque=1.0), footprint_radius=0.3, height=1.0,
        force_height=0.5, mass=10.0,
        limits=RobotLimits(v_min=-1.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0),
    )  # fmt: skip
    none = np.zeros(0, np.bool_)
    parts = EnvironmentParts(
        walls=np.zeros((0, 4)), wall_heights=np.zeros((0, 2)), stops_robot=none, stops_crowd=none,
        zones={}, portals={},
    )  # fmt: skip
    rig = add_plant(DiagramBuilder(), parts, robot, None)
    body = rig.plant.GetBodyByName("base_link")
    assert len(rig.plant.GetCollisionGeometriesForBody(body)) == 1


def test_wheels_stay_spheres(tmp_path: Path) -> None:
    wheel = """<link name="wheel"><inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1"
      ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><mesh filename="arm.obj"/></geometry>
      </collision></link><joint name="turns" type="continuous"><parent link="base_link"/>
      <child link="wheel"/><axis xyz="0 1 0"/></joint></robot>"""
    _prism(tmp_path / "arm.obj")
    (tmp_path / "two.urdf").write_text(_URDF.replace("</robot>", wheel), encoding="utf-8")
    described = read_published(
        tmp_path / "two.urdf", wheels={"turns": PublishedWheel(0.1, 1.0)}, shell="", meshes="hulls"
    )
    shapes = [s.tag for s in described.link("wheel").findall("collision/geometry/*")]
    assert shapes == ["sphere"]


def test_a_piece_without_corners_is_refused() -> None:
    with pytest.raises(PluginError, match="at least four corners"):
        corners_of(Xml.fromstring('<mesh corners="0 0 0 1 1 1"/>'))


def test_an_l_is_cut_into_pieces_always_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("coacd", reason="the extra meshes is not installed")
    pytest.importorskip("trimesh", reason="the extra meshes is not installed")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    first = _described(tmp_path, "pieces")
    texts = [Xml.tostring(first.model)]
    kept = list((tmp_path / "cache" / "crowdbot" / "pieces").iterdir())
    assert len(kept) == 1
    texts.append(Xml.tostring(_described(tmp_path, "pieces").model))  # from the cache
    kept[0].write_text("{broken", encoding="utf-8")
    texts.append(Xml.tostring(_described(tmp_path, "pieces").model))  # cut again
    assert texts[0] == texts[1] == texts[2]
    _, found = simplified(first, ())
    assert 2 <= len(found) <= pieces.MOST_PIECES
    assert all(len(piece.corners) <= pieces.MOST_CORNERS for piece in found)
    # The notch of the L is free, which a hull would fill.
    notch = np.array([0.4, 0.0, 0.6]) * [0.5, 1.0, 0.5] + [0.1, 0.0, 0.25]
    assert not any(
        np.all(piece.corners.min(axis=0) < notch) and np.all(notch < piece.corners.max(axis=0))
        for piece in found
    )
