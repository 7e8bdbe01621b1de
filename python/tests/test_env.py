"""grrl/Discover-v0 is a Gymnasium environment, and runs as the C++ programs do."""

import resource
import warnings

import gymnasium
import numpy as np
import pytest
from conftest import run
from gymnasium.utils.env_checker import check_env
from test_learner import trials_of

import grrl


def make(**given):
    return gymnasium.make("grrl/Discover-v0", **{"object": "RPR", **given})


@pytest.mark.parametrize("points", [False, True])
def test_gymnasiums_own_check(points):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(make(points=points, render_mode="rgb_array").unwrapped)


def play(env, seed, actions):
    first, info = env.reset(seed=seed)
    steps = [(first, 0.0, False, False, info)]
    for action in actions:
        steps.append(env.step(action))
        if steps[-1][2] or steps[-1][3]:
            break
    return steps


def assert_equal(one, two):
    assert len(one) == len(two)
    for a, b in zip(one, two):
        assert a[1:4] == b[1:4] and a[4]["term"] == b[4]["term"]
        assert a[0].keys() == b[0].keys()
        for name in a[0]:
            assert np.array_equal(a[0][name], b[0][name]), name


def test_a_seed_gives_the_same_run():
    actions = [2, 8, 1, 14, 3, 0, 7]
    one, two = (play(make(points=True), 5, actions) for _ in range(2))
    assert_equal(one, two)
    other = play(make(points=True), 6, actions)
    assert not np.array_equal(one[0][0]["points"], other[0][0]["points"])


@pytest.mark.parametrize("policy", ["learn", "random"])
def test_trials_of_the_program(tmp_path, policy):
    """What grrl-experiment needed, the environment needs: its pushes, made again here."""
    run("EXPERIMENT", "--object", "RPRPRPR", "--experiments", 1, "--trials", 5, "--seed", 2, "--policy",
        policy, "--out", tmp_path)
    learner = grrl.Learner(policy, seed=2001)
    env = make(object="RPRPRPR")
    for row in trials_of(tmp_path):
        result = grrl.run_trial(learner, "RPRPRPR", int(row["trial"]))
        _, info = env.reset(seed=2001) if result.trial == 1 else env.reset()
        assert info["trial"] == result.trial
        rewards = []
        for body, direction in result.actions:
            names = [b.name for b in env.unwrapped._model.bodies]
            _, reward, found, capped, info = env.step(names.index(body) * 6 + direction)
            rewards.append(reward)
            assert found == (len(rewards) == int(row["pushes"]) and row["outcome"] == "discovered")
        assert rewards == result.rewards
        assert (found, capped) == (row["outcome"] == "discovered", row["outcome"] == "capped")


def test_rewards_are_links_and_joints_revealed():
    env = make()
    random = np.random.default_rng(1)
    observation, info = env.reset(seed=1)
    links, joints, total, found = observation["link_mask"].sum(), 0, 0.0, False
    while not found:
        action = random.choice(np.flatnonzero(info["action_mask"]))
        observation, reward, found, capped, info = env.step(action)
        total += reward
        assert not capped
    links = observation["link_mask"].sum() - links
    joints = np.count_nonzero(np.triu(observation["joints"].sum(axis=0)))
    assert observation["link_mask"].sum() == 4 and joints == 3
    assert total == links + joints + 1
    assert "P(" in info["term"]
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.unwrapped.step(0)


def test_masks_and_pushes_at_nothing():
    env = make(cap=3)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.unwrapped.step(0)
    observation, info = env.reset(seed=1)
    n = observation["link_mask"].sum()
    assert info["action_mask"].sum() == n * 6
    assert np.array_equal(env.unwrapped.action_masks(), info["action_mask"].astype(bool))
    assert env.observation_space.contains(observation)
    for push in (1, 2, 3):
        after, reward, found, capped, info = env.step(95)
        assert (reward, found, capped) == (0.0, False, push == 3)
        assert not info["valid"] and info["pushes"] == push
        assert np.array_equal(after["links"], observation["links"])
    for bad, error in ((96, ValueError), (-1, ValueError), (0.5, TypeError), (None, TypeError)):
        env.reset()
        with pytest.raises(error, match="action"):
            env.unwrapped.step(bad)


def test_trials_of_a_seed():
    env = make()
    _, info = env.reset(seed=4)
    _, second = env.reset()
    assert (info["trial"], second["trial"]) == (1, 2)
    third, _ = env.reset(options={"trial": 3})
    again, _ = make().reset(seed=4, options={"trial": 3})
    assert np.array_equal(third["links"], again["links"])


def test_render():
    env = make(render_mode="rgb_array")
    env.reset(seed=1)
    before = env.render()
    assert before.shape == (384, 480, 3) and before.dtype == np.uint8
    assert (before == (0, 114, 178)).all(axis=2).any()  # the first body's colour
    env.step(2)
    assert not np.array_equal(before, env.render())


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_vectorised(mode):
    envs = gymnasium.make_vec("grrl/Discover-v0", num_envs=2, vectorization_mode=mode, object="RR")
    try:
        observations, info = envs.reset(seed=[1, 2])
        assert observations["links"].shape == (2, grrl.MAX_LINKS, 8)
        assert info["action_mask"].shape == (2, grrl.MAX_LINKS * 6)
        single, _ = make(object="RR").reset(seed=2)
        assert np.array_equal(observations["links"][1], single["links"])
        for _ in range(3):
            observations, rewards, *_ = envs.step(np.array([2, 2]))
            assert rewards.shape == (2,)
    finally:
        envs.close()


def test_memory_is_flat():
    env, random = make(object="RR", cap=10), np.random.default_rng(1)

    def episodes(n):
        for _ in range(n):
            _, info = env.reset()
            over = False
            while not over:
                _, _, found, capped, info = env.step(random.choice(np.flatnonzero(info["action_mask"])))
                over = found or capped
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    env.reset(seed=1)
    before = episodes(10)
    assert episodes(60) - before < 2048  # KiB; one world or model leaked an episode is more
