"""Figures of people from glTF: upright, on the floor, 1 m high, one mesh for each phase."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
from tests.core.figures.small_gltf import Writer, edit, write
from tests.paths import DATA


def test_a_figure_stands_upright_on_the_floor_and_looks_ahead(tmp_path: Path) -> None:
    figure = load_figure(write(tmp_path / "a.glb"))
    ((part,),) = figure.phases
    np.testing.assert_allclose(part.points.min(axis=0), [-0.05, -0.15, 0.0], atol=1e-6)
    np.testing.assert_allclose(part.points.max(axis=0), [0.05, 0.15, 1.0], atol=1e-6)
    assert part.triangles.shape == (12, 3)
    srgb = [1.055 * linear ** (1.0 / 2.4) - 0.055 for linear in (1.0, 0.03, 0.01)]
    assert part.colour == pytest.approx(srgb)
    assert figure.phase(3.7, 1.7) == 0


@pytest.mark.parametrize(
    ("how", "low", "high"),
    [("node", 0.5, 0.5), ("skin", 0.0, 0.5), ("each", 0.0, 0.5), ("morph", 0.5, 0.5)],
)
def test_phases_are_poses_of_the_walk(tmp_path: Path, how: str, low: float, high: float) -> None:
    figure = load_figure(write(tmp_path / "a.glb", moves=how))
    assert len(figure.phases) == PHASES
    (first,), (half,) = figure.phases[0], figure.phases[PHASES // 2]
    moved = half.points[:, 0] - first.points[:, 0]  # 1 m of 2 m
    np.testing.assert_allclose(moved[first.points[:, 2] < 0.5], low, atol=1e-6)
    np.testing.assert_allclose(moved[first.points[:, 2] > 0.5], high, atol=1e-6)
    assert [figure.phase(0.83 * 1.7 * s, 1.7) for s in (0.0, 0.51, 1.01)] == [0, 4, 0]


def test_a_walk_away_from_its_place_stays_above_it(tmp_path: Path) -> None:
    figure = load_figure(write(tmp_path / "a.glb", moves="away"))
    for (part,) in figure.phases:
        np.testing.assert_allclose(part.points, figure.phases[0][0].points, atol=1e-6)


def test_sparse_points_strips_and_other_numbers_are_read(tmp_path: Path) -> None:
    whole = load_figure(write(tmp_path / "a.glb")).phases[0][0]

    def sparse(document: dict[str, Any], made: Writer) -> None:
        points = document["accessors"][0]
        rows = np.arange(8, dtype="<u2")
        values = made.data[: 8 * 12]
        points["sparse"] = {
            "count": 8, "values": {"bufferView": made.blob(values)},
            "indices": {"bufferView": made.blob(rows.tobytes()), "componentType": 5123},
        }  # fmt: skip
        del points["bufferView"]

    found = load_figure(edit(write(tmp_path / "b.glb"), sparse)).phases[0][0]
    np.testing.assert_array_equal(found.points, whole.points)

    def strip(document: dict[str, Any], made: Writer) -> None:
        primitive = document["meshes"][0]["primitives"][0]
        primitive |= {"mode": 5, "indices": made.add(np.array([0, 1, 4, 5], "<u2"), "SCALAR")}

    found = load_figure(edit(write(tmp_path / "c.glb"), strip)).phases[0][0]
    assert found.triangles.tolist() == [[0, 1, 4], [4, 1, 5]]  # the same side of both

    def quantised(document: dict[str, Any], _made: Writer) -> None:
        document["extensionsRequired"] = ["KHR_mesh_quantization"]

    assert load_figure(edit(write(tmp_path / "d.glb"), quantised)).phases[0][0].triangles.size


def test_a_texture_is_multiplied_by_the_base_colour_and_moved(tmp_path: Path) -> None:
    def change(document: dict[str, Any], _made: Writer) -> None:
        looks = document["materials"][0]["pbrMetallicRoughness"]
        looks["baseColorFactor"] = [1.0, 0.0, 1.0, 1.0]
        moved = {"offset": [0.25, 0.5], "scale": [2.0, 2.0]}
        looks["baseColorTexture"]["extensions"] = {"KHR_texture_transform": moved}

    path = edit(write(tmp_path / "a.glb", textured=True), change)
    ((part,),) = load_figure(path).phases
    assert shown_figure(load_figure(path))["colours"] == "000000" * 8  # green, without green
    assert part.uv is not None
    np.testing.assert_allclose(part.uv, np.tile([0.25, 0.5], (8, 1)))


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
    (tmp_path / "g.gltf").write_text('{"asset": {}, "nodes": {"a": 1}}', encoding="utf-8")
    with pytest.raises(InputError, match="'nodes' is not a list"):
        load_figure(tmp_path / "g.gltf")
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
