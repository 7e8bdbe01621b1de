"""grrl.perceive answers as grrl-perceive does, whatever the tracks come in."""

import csv
import json
import math

import numpy as np
import pandas as pd
import pytest
from conftest import hinge, run, write_csv

import grrl


def assert_same(model, answer):
    """The model, number by number, and the JSON of grrl-perceive."""
    def g(value):
        return float(f"{value:.6g}")

    degrees = 180 / math.pi
    assert model.term == answer["term"]
    assert (model.unit, model.profile) == (answer["unit"], answer["profile"])
    assert g(model.noise) == answer["noise"]
    assert model.counts["keyframes"] == answer["keyframes"]
    assert model.counts["tracks"] == answer["tracks"]
    for name in ("outliers", "refused", "beyond_capacity"):
        assert model.counts[name] == answer["dropped"][name]
    assert {k: model.counts[k] for k in ("empty", "marked", "frozen")} == answer["not_visible"]
    assert len(model.warnings) == len(answer["warnings"])
    assert len(model.bodies) == len(answer["bodies"])
    for body, said in zip(model.bodies, answer["bodies"]):
        assert body.name == said["name"]
        assert [g(x) for x in body.centroid] == [said["x"], said["y"]]
        assert [g(body.length), g(body.width)] == [said["length"], said["width"]]
        assert [g(x) for x in body.axis] == said["axis"]
        assert sorted(body.points) == sorted(said["features"])
    assert len(model.joints) == len(answer["joints"])
    for joint, said in zip(model.joints, answer["joints"]):
        names = [model.bodies[i].name for i in (joint.a, joint.b)]
        assert (*names, joint.type) == (said["a"], said["b"], said["type"])
        for field in ("probability", "p_revolute", "p_prismatic", "p_disconnected"):
            assert g(getattr(joint, field)) == said[field]
        assert [g(x) for x in joint.point] == [said["x"], said["y"]]
        assert [g(joint.covariance[i]) for i in ((0, 0), (0, 1), (1, 1))] == said["covariance"]
        scale = degrees if joint.type == "revolute" else 1.0
        assert [joint.lower * scale, joint.upper * scale] == pytest.approx(
            [said["lower"], said["upper"]], rel=1e-5, abs=1e-9)
        if joint.type == "prismatic":
            assert [g(x) for x in joint.axis] == said["axis"]
    assert len(model.pairs) == len(answer["pairs"])
    for pair, said in zip(model.pairs, answer["pairs"]):
        assert pair.relation == said["relation"]
        assert g(pair.p_revolute) == said["p_revolute"]
        assert pair.why == (said["reason"] or "their motion shows no joint, with a probability of "
                            "0.95 and more")
    assert sorted(model.background) == sorted(answer["background"])
    assert sorted(model.unassigned) == sorted(answer["unassigned"])


def drawer(seed=2):
    scene = hinge(seed=seed, turn=0.0)
    scene[:, 10:, 0] += np.linspace(0, 60, len(scene))[:, None]
    return scene


def two_apart(seed=3):
    """Two bodies that move freely: no joint ties them."""
    scene = hinge(seed=seed)
    scene[:, 10:] += np.linspace(0, 1, len(scene))[:, None, None] ** 2 * (80, 120)
    return scene


def lost(seed=4):
    """Points that a tracker goes on writing at (0, 0), and gaps."""
    scene = hinge(frames=60, seed=seed)
    scene[40:, 3] = 0
    scene[45:, 14] = 0
    scene[10:20, 7] = np.nan
    return scene


def many(seed=5):
    return hinge(points=150, seed=seed)


def nearer(seed=6):
    """A camera that nears: what is rigid grows."""
    scene = hinge(seed=seed)
    return scene * np.linspace(1, 1.4, len(scene))[:, None, None]


def renewed(seed=7):
    """A tracker that detects anew: the points go on under other ids."""
    scene = hinge(frames=60, seed=seed)
    again = np.full_like(scene, np.nan)
    again[30:], scene[30:] = scene[30:], np.nan
    return np.concatenate([scene, again], axis=1)


SCENES = {"hinge": hinge, "drawer": drawer, "apart": two_apart, "lost": lost, "many": many,
          "nearer": nearer, "renewed": renewed}


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("unit,noise", [("mm", 0.3), ("mm", "auto"), ("px", "auto"), ("px", None)])
def test_same_answer_as_the_program(tmp_path, scene, unit, noise):
    path = tmp_path / "tracks.csv"
    write_csv(path, SCENES[scene]())
    given = [] if noise is None else ["--noise", noise]
    answer = json.loads(run("PERCEIVE", "--json", "--unit", unit, *given, path))
    assert_same(grrl.perceive(grrl.io.from_csv(path), unit, noise), answer)
    table = pd.read_csv(path)
    assert_same(grrl.perceive(table.sample(frac=1, random_state=1), unit, noise), answer)


def test_same_answer_for_two_pictures(tmp_path):
    path = tmp_path / "tracks.csv"
    write_csv(path, hinge(frames=2))
    answer = json.loads(run("PERCEIVE", "--json", "--unit", "mm", "--noise", "0.3", path))
    model = grrl.perceive(grrl.io.from_csv(path), "mm", 0.3)
    assert_same(model, answer)
    assert model.joints


def seen_aside(table):
    """Pixels of millimetres on a table that is tilted by 40 degrees; y points down."""
    x, y = np.moveaxis(np.asarray(table, float), -1, 0)
    far = 900 + math.sin(0.7) * y
    return np.stack([640 + 1000 * x / far, 360 - 1000 * math.cos(0.7) * y / far], -1)


def test_rectified_by_four_points_as_the_program_does(tmp_path):
    path = tmp_path / "tracks.csv"
    corners = np.array([[-150, -150], [150, -150], [150, 100], [-150, 100]])
    places = np.hstack([np.round(seen_aside(corners), 3), corners])
    write_csv(path, seen_aside(hinge()), "frame,point,x_px,y_px")
    text = " ".join(f"{a:.3f},{b:.3f}={c:g},{d:g}" for a, b, c, d in places)
    answer = json.loads(run("PERCEIVE", "--json", "--unit", "mm", "--rectify", text, path))
    model = grrl.perceive(grrl.io.from_csv(path), "mm", None, rectify=places)
    assert_same(model, answer)
    assert model.joints[0].type == "revolute" and np.allclose(model.joints[0].point, (40, -20), atol=2)


def test_rectify_is_four_points_of_a_table():
    places = np.array([[0, 0, 0, 0], [9, 0, 1, 0], [9, 9, 1, 1], [0, 9, 0, 1]])
    with pytest.raises(ValueError, match="four rows"):
        grrl.perceive(hinge(), "mm", rectify=places[:3])
    with pytest.raises(ValueError, match="no three of them on a line"):
        grrl.perceive(hinge(), "mm", rectify=places * [1, 0, 1, 1])
    with pytest.raises(ValueError, match="with rectify, of the table"):
        grrl.perceive(hinge(), "px", rectify=places)


def test_tracks_that_go_on_under_other_ids():
    model = grrl.perceive(renewed(), "mm", 0.3)
    assert model.counts["tracks_joined"] > 15 and model.joints[0].type == "revolute"


def test_same_answer_for_an_array(tmp_path):
    path = tmp_path / "tracks.csv"
    scene = np.round(lost(), 3)
    write_csv(path, scene)
    answer = json.loads(run("PERCEIVE", "--json", "--unit", "mm", "--noise", "0.3", path))
    assert_same(grrl.perceive(scene, "mm", 0.3), answer)


def test_example_and_its_motion(tmp_path, hinge_csv):
    motion = tmp_path / "motion.csv"
    answer = json.loads(run("PERCEIVE", "--json", "--unit", "mm", "--motion", motion, hinge_csv))
    model = grrl.perceive(grrl.io.from_csv(hinge_csv, unit="mm"), noise=None)
    assert_same(model, answer)
    with open(motion, encoding="utf-8") as file:
        said = {int(row["frame"]): math.radians(float(row["value"])) for row in csv.DictReader(file)}
    found = dict(zip(model.frames.tolist(), model.joints[0].motion))
    assert found == pytest.approx(said)


def test_motion_is_left_out_on_request():
    model = grrl.perceive(hinge(), "mm", 0.3, motion=False)
    assert model.joints and model.joints[0].motion is None


def test_pivot_lies_where_it_is():
    model = grrl.perceive(hinge(), "mm")
    joint, = model.joints
    assert joint.type == "revolute" and joint.probability > 0.99
    deviation = joint.point - (40, -20)
    assert deviation @ np.linalg.solve(joint.covariance, deviation) < 14  # 0.999 of two dimensions
    assert model.noise == pytest.approx(0.3, rel=0.1)
    assert joint.motion[-1] - joint.motion[0] == pytest.approx(0.8, abs=0.03)


def test_open_pairs_say_why():
    still = grrl.perceive(two_apart(), "mm", 0.3)
    assert [pair.relation for pair in still.pairs] == ["disconnected"]
    assert "no joint" in still.pairs[0].why
    assert "disconnected" in str(still)


def test_results_do_not_depend_on_the_layout():
    scene = hinge().astype(np.float32)
    wanted = grrl.perceive(scene, "mm", 0.3)
    read_only = scene.copy()
    read_only.flags.writeable = False
    strided = np.repeat(scene, 2, axis=1)[:, ::2]
    for other in (read_only, strided, np.asfortranarray(scene), scene.astype(np.float64),
                  scene.astype(">f4"), np.ma.masked_invalid(scene)):
        model = grrl.perceive(other, "mm", 0.3)
        assert model.term == wanted.term
        assert np.array_equal(model.joints[0].covariance, wanted.joints[0].covariance)


def test_frame_by_frame_as_a_recording():
    scene = hinge()
    scene[5:9, 2] = np.nan
    whole = grrl.perceive(scene, "mm", 0.3)
    perception = grrl.Perception("mm", 0.3)
    assert perception.model.bodies == () and perception.update().bodies == ()
    for f, points in enumerate(scene):
        perception.observe(points, pushing=0 < f < len(scene) - 1)
    model = perception.update()
    assert model.term == whole.term
    assert np.array_equal(model.joints[0].point, whole.joints[0].point)
    perception.reset()
    assert perception.update().bodies == ()


def test_unit_is_needed():
    with pytest.raises(ValueError, match="'px', 'mm' or 'm'"):
        grrl.perceive(hinge())


def test_warnings_speak_python():
    scene = hinge() / 1000
    model = grrl.perceive(scene, "mm", 0.7)
    assert any("unit=" in text for text in model.warnings)
    assert not any("--" in text for text in model.warnings)


def test_plot():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    for scene in (hinge(), drawer()):
        model = grrl.perceive(scene, "px", 0.5, profile="tracker")
        ax = model.plot()
        assert model.term in ax.get_title()
        assert ax.yaxis_inverted()
        labels = [text.get_text() for text in ax.get_legend().get_texts()]
        assert any(model.joints[0].type in label for label in labels)
        assert ax.get_xlabel() == "x (px)"
        ax.figure.canvas.draw()
