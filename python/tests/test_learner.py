"""The learner in Python does what the C++ programs do, push for push."""

import csv

import numpy as np
import pytest
from conftest import run

import grrl


def trials_of(folder):
    with open(folder / "trials.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("policy", ["learn", "paper", "greedy", "random"])
def test_same_trials_as_the_program(tmp_path, policy):
    trials = 50 if policy == "learn" else 8
    run("EXPERIMENT", "--object", "RPRPRPR", "--experiments", 1, "--trials", trials, "--seed", 1,
        "--policy", policy, "--out", tmp_path)
    rows = trials_of(tmp_path)
    assert len(rows) == trials
    learner = grrl.Learner(policy, seed=1001)
    for row in rows:
        result = grrl.run_trial(learner, "RPRPRPR", int(row["trial"]))
        assert result.pushes == int(row["pushes"]) == len(result.actions)
        assert result.discovered == (row["outcome"] == "discovered")
        assert result.wrong_joints == int(row["wrong_joints"])


def test_store_goes_round(tmp_path):
    one = grrl.Learner("learn", seed=2)
    for trial in (1, 2, 3):
        grrl.run_trial(one, "RPR", trial)
    path = tmp_path / "a.store"
    one.save(path)
    two = grrl.Learner("learn", seed=2)
    two.load(path)
    assert two.usage == one.usage and two.usage.n > 0
    assert grrl.run_trial(one, "RPR", 4).actions == grrl.run_trial(two, "RPR", 4).actions
    assert two.to_bytes() == one.to_bytes()
    assert list(tmp_path.iterdir()) == [path]
    one.clear()
    assert one.usage.n == 0


def test_stores_of_others_are_refused(tmp_path):
    path = tmp_path / "a.store"
    learner = grrl.Learner("learn")
    grrl.run_trial(learner, "RR")
    learner.save(path)
    with pytest.raises(ValueError, match="a.store: load: .*policy"):
        grrl.Learner("paper").load(path)
    whole = path.read_bytes()
    for n in range(len(whole)):
        with pytest.raises(ValueError, match="load"):
            learner.from_bytes(whole[:n])
    with pytest.raises(ValueError, match="does not learn"):
        grrl.Learner("random").save(path)
    assert path.read_bytes() == whole


def test_order_of_calls():
    learner, world = grrl.Learner("learn"), grrl.World("RR", 1)
    with pytest.raises(RuntimeError, match="begin_trial comes first"):
        learner.perceive()
    learner.begin_trial(1)
    with pytest.raises(RuntimeError, match="perceive comes first"):
        learner.choose()
    assert learner.perceive() is False
    for _ in range(10):
        learner.observe(world.observe())
    assert learner.perceive() is True
    with pytest.raises(RuntimeError, match="the push and perceive come first"):
        learner.learn(False)
    with pytest.raises(ValueError, match="no such body"):
        learner.adopt("f77", 0)
    with pytest.raises(ValueError, match="direction"):
        learner.adopt("f1", 6)
    with pytest.raises(ValueError, match="'f3'"):
        learner.adopt("blade", 0)
    decision = learner.adopt("f1", 2)
    assert (decision.reason, decision.direction_deg) == ("adopted", 90)
    assert str(decision).startswith("f1 at 90 deg, adopted")


def test_decisions_explain_themselves():
    learner = grrl.Learner("learn", seed=1)
    world = grrl.World("RPR", 1, 1)
    learner.begin_trial(1)
    for _ in range(10):
        learner.observe(world.observe().points, world.observe().ids)
    learner.perceive()
    decision = learner.choose()
    assert str(decision).startswith(f"{decision.body} at {decision.direction_deg} deg, new action")
    assert decision.body == learner.model.bodies[decision.link].name
    start, end = np.array(decision.push.start), np.array(decision.push.end)
    along = (end - start) / np.linalg.norm(end - start)
    frame = learner.model.bodies[decision.link].frame
    angle = np.radians(decision.direction_deg)
    assert along == pytest.approx(np.cos(angle) * frame[0] + np.sin(angle) * frame[1], abs=1e-4)


def test_nothing_to_push():
    learner = grrl.Learner("learn")
    learner.begin_trial(1)
    for _ in range(10):
        learner.observe(np.array([[0.5, 0.5]]))
    learner.perceive()
    assert learner.choose() is None
    assert learner.term == "lb"


def test_a_scene_with_nothing_to_push(monkeypatch):
    def settle(learner, world):
        learner.observe(np.array([[0.5, 0.5]]))  # one point is no link
        learner.perceive()

    monkeypatch.setattr(grrl.world, "settle", settle)
    with pytest.raises(RuntimeError, match="nothing to push; less noise"):
        grrl.run_trial(grrl.Learner("learn"), "RR")
