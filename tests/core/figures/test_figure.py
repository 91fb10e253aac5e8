"""Figures of people from glTF: upright, on the floor, 1 m high, one mesh for each phase."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from crowdbot.core.environments.build import build_environment
from crowdbot.core.figures.figure import PHASES, load_figure
from crowdbot.core.figures.shown import shown_figure
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.solids import solid_people, solids_of
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.cameras.figure_pool import figure_obj
from crowdbot.errors import InputError
from tests.core.figures.small_gltf import write
from tests.paths import DATA


def test_a_figure_stands_upright_on_the_floor_and_looks_ahead(tmp_path: Path) -> None:
    figure = load_figure(write(tmp_path / "a.glb"))
    ((part,),) = figure.phases
    np.testing.assert_allclose(part.points.min(axis=0), [-0.05, -0.15, 0.0], atol=1e-6)
    np.testing.assert_allclose(part.points.max(axis=0), [0.05, 0.15, 1.0], atol=1e-6)
    assert part.triangles.shape == (12, 3)
    assert part.colour == pytest.approx((1.0, 0.2, 0.1))
    assert figure.phase(3.7, 1.7) == 0


@pytest.mark.parametrize(("how", "low", "high"), [("node", 0.5, 0.5), ("skin", 0.0, 0.5),
                                                  ("morph", 0.5, 0.5)])  # fmt: skip
def test_phases_are_poses_of_the_walk(tmp_path: Path, how: str, low: float, high: float) -> None:
    figure = load_figure(write(tmp_path / "a.glb", moves=how))
    assert len(figure.phases) == PHASES
    (first,), (half,) = figure.phases[0], figure.phases[PHASES // 2]
    moved = half.points[:, 0] - first.points[:, 0]  # 1 m of 2 m
    np.testing.assert_allclose(moved[first.points[:, 2] < 0.5], low, atol=1e-6)
    np.testing.assert_allclose(moved[first.points[:, 2] > 0.5], high, atol=1e-6)
    assert [figure.phase(0.83 * 1.7 * s, 1.7) for s in (0.0, 0.51, 1.01)] == [0, 4, 0]


def test_a_texture_comes_along(tmp_path: Path) -> None:
    ((part,),) = load_figure(write(tmp_path / "a.glb", textured=True)).phases
    assert part.texture.startswith(b"\x89PNG")
    assert part.uv is not None
    assert part.uv.shape == (8, 2)


def test_other_files_are_refused_by_name(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(b"no figure")
    with pytest.raises(InputError, match=r"a\.glb: is not glTF"):
        load_figure(tmp_path / "a.glb")
    (tmp_path / "b.gltf").write_text(
        '{"asset": {}, "extensionsRequired": ["KHR_draco_mesh_compression"]}', encoding="utf-8"
    )
    with pytest.raises(InputError, match="KHR_draco"):
        load_figure(tmp_path / "b.gltf")
    (tmp_path / "c.gltf").write_text('{"asset": {}}', encoding="utf-8")
    with pytest.raises(InputError, match="no triangles"):
        load_figure(tmp_path / "c.gltf")
    (tmp_path / "d.gltf").write_text(
        '{"asset": {}, "buffers": [{"uri": "../secret.bin", "byteLength": 1}]}', encoding="utf-8"
    )
    with pytest.raises(InputError, match="not in its folder"):
        load_figure(tmp_path / "d.gltf")
    whole = write(tmp_path / "e.glb").read_bytes()
    (tmp_path / "f.glb").write_bytes(whole[: len(whole) - 80])
    with pytest.raises(InputError, match=r"f\.glb"):
        load_figure(tmp_path / "f.glb")


def test_a_document_names_figures_and_changes_no_hash_without(tmp_path: Path) -> None:
    write(tmp_path / "a.glb")
    registry = discover(allow=())
    text = (DATA / "short_way.yaml").read_text(encoding="utf-8")
    (tmp_path / "plain.yaml").write_text(text, encoding="utf-8")
    plain = pick(open_spec(str(tmp_path / "plain.yaml"), registry), None)
    dressed = text.replace("mass: 75 kg", "mass: 75 kg, figures: {a: a.glb}")
    (tmp_path / "x.yaml").write_text(dressed, encoding="utf-8")
    found = pick(open_spec(str(tmp_path / "x.yaml"), registry), None)
    assert plain.crowd is not None
    assert found.crowd is not None
    assert "figures" not in plain.crowd.body.model_dump(mode="json")
    asset = found.crowd.body.figures["a"]
    assert asset.sha256 is not None
    assert len(load_figure(asset.file).phases) == 1


def test_the_obj_of_a_part_has_its_height_and_normals(tmp_path: Path) -> None:
    ((part,),) = load_figure(write(tmp_path / "a.glb", textured=True)).phases
    lines = figure_obj(part, 1.8).splitlines()
    points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
    normals = np.array([line.split()[1:] for line in lines if line.startswith("vn ")], float)
    assert points[:, 2].max() == pytest.approx(1.8)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-4)
    assert np.all(np.sum(normals * (points - points.mean(axis=0)), axis=1) > 0.0)
    assert lines[0] == "mtllib figure.mtl"
    assert sum(line.startswith("f ") for line in lines) == 12


def test_a_page_gets_few_corners_and_their_colours(tmp_path: Path) -> None:
    shown = shown_figure(load_figure(write(tmp_path / "a.glb", moves="skin", textured=True)))
    assert len(shown["phases"]) == PHASES
    assert all(len(points) == 3 * 8 for points in shown["phases"])
    assert shown["colours"] == "00ff00" * 8
    assert len(shown["triangles"]) == 36
    assert max(shown["phases"][0][2::3]) == 1000


def test_a_figure_that_is_gone_is_told_and_people_keep_their_bodies(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    write(tmp_path / "a.glb")
    text = (DATA / "short_way.yaml").read_text(encoding="utf-8")
    text = text.replace("mass: 75 kg", "mass: 75 kg, figures: {a: a.glb}")
    (tmp_path / "x.yaml").write_text(text, encoding="utf-8")
    registry = discover(allow=())
    scenario = pick(open_spec(str(tmp_path / "x.yaml"), registry), None)
    agents = population(scenario, registry).agents
    people = solid_people(scenario, agents)
    parts = build_environment(registry, scenario.environment)
    assert len(solids_of(parts, {}, people)["people"]["figures"]) == 1
    (tmp_path / "a.glb").unlink()
    people = solid_people(scenario, agents)
    assert people is not None
    assert people.figures == []
    assert "without figures" in caplog.text
