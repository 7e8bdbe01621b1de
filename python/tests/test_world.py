"""The world is the simulator's, bit for bit, and keeps its truth to itself."""

import numpy as np
import pytest

import grrl

PUSH = grrl.Push((-0.9, 0.0), (0.9, 0.0), travel=0.05, speed=0.2, timeout=10.0)


def frames_of(seed):
    world = grrl.World("RPR", seed)
    result, frames = world.push(PUSH)
    return world, result, frames


def test_same_seed_same_run():
    one, two, other = frames_of(5), frames_of(5), frames_of(6)
    assert one[0].state_hash == two[0].state_hash != other[0].state_hash
    assert one[1] == two[1]
    assert len(one[2]) == len(two[2]) > 1
    for a, b in zip(one[2], two[2]):
        assert np.array_equal(a.ids, b.ids) and np.array_equal(a.points, b.points)
        assert a.time_s == b.time_s
    assert one[0].time == pytest.approx(len(one[2]) / 30)


def test_a_frame():
    frame = grrl.World("RPR", 1).observe()
    assert frame.ids.dtype == np.int32 and frame.points.shape == (len(frame), 2)
    assert np.all(np.diff(frame.ids) > 0)
    assert np.all(np.abs(frame.points) < 2)


def test_refused_push_says_why():
    world = grrl.World("RPR", 1)
    result, frames = world.push(grrl.Push((0, 0), (0, 0)))
    assert (result.reason, frames) == ("refused", [])
    assert result.why
    assert world.begin_push(PUSH) == ""
    assert "wait for its result" in world.begin_push(PUSH)


def test_truth_is_the_supervisors():
    world = grrl.World("RPR", 1)
    supervisor = grrl.Supervisor("RPR")
    public = {name for name in dir(world) if not name.startswith("_")}
    assert public == {"observe", "begin_push", "step", "push", "result", "time", "state_hash"}
    native = {name for name in dir(world._native) if not name.startswith("_")}
    assert native == {"observe", "begin_push", "step", "push_result", "time_s", "state_hash"}
    assert supervisor.links == 4
    assert supervisor.joints == [(0, 1, "revolute"), (1, 2, "prismatic"), (2, 3, "revolute")]
    assert supervisor.poses(world).shape == (4, 3)
    assert supervisor.sizes(world).shape == (4, 2)
    assert supervisor.joint_values(world).shape == (3,)
    frame = world.observe()
    links = supervisor.link_of_point(world)[frame.ids]
    for link in range(4):
        off = frame.points[links == link] - supervisor.poses(world)[link, :2]
        assert len(off) >= 6
        assert np.all(np.hypot(*off.T) < 0.5 * np.hypot(*supervisor.sizes(world)[link]) + 0.005)


def test_objects_that_come_with_grrl():
    assert grrl.Supervisor("wooden-toy").links == 4
    assert grrl.World("scissors", 1).observe().ids.size > 10
    with pytest.raises(ValueError, match="garden-shears, scissors, wooden-toy"):
        grrl.World("hammer")


def test_background_is_not_to_be_found():
    assert grrl.Supervisor("R(lb, l1)").links == 1
    assert grrl.Supervisor("R(lb, l1)").joints == []


def test_judges_models_and_learners():
    learner = grrl.Learner("learn", seed=3)
    result = grrl.run_trial(learner, "RR")
    right, wrong = grrl.Supervisor("RR"), grrl.Supervisor("RPR")
    for believed in (learner, learner.model):
        assert bool(right.judge(believed)) == result.discovered
        verdict = wrong.judge(believed)
        assert not verdict and "prismatic joint missing" in verdict.text
        assert verdict.missing_prismatic == 1


def test_seeds_of_trials():
    assert grrl.trial_seed(1, 1) != grrl.trial_seed(1, 2)
    assert grrl.World("RR", grrl.trial_seed(4, 2)).state_hash == grrl.World("RR", 4, 2).state_hash
