"""Bad arrays raise ValueError or TypeError that say what is right; nothing crashes."""

import numpy as np
import pytest
from conftest import hinge
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import grrl

SETTINGS = settings(max_examples=150, deadline=None, derandomize=True,
                    suppress_health_check=[HealthCheck.too_slow])

ANY_FLOAT = st.floats(allow_nan=True, allow_infinity=True, width=64)
DTYPES = st.sampled_from(["f2", "f4", "f8", ">f8", "i1", "i8", "u8", "c16", "O", "U3", "?", "M8[s]"])


@pytest.mark.parametrize("bad,error,words", [
    (np.zeros((3, 4)), ValueError, r"\(frames, points, 2\), but it has \(3, 4\)"),
    (np.zeros((3, 4, 3)), ValueError, r"\(frames, points, 2\), but it has \(3, 4, 3\)"),
    (np.zeros((0, 4, 2)), ValueError, "is empty"),
    (np.zeros((3, 0, 2)), ValueError, "is empty"),
    (np.full((3, 4, 2), np.inf), ValueError, r"tracks\[0, 0, 0\] is inf: a position must be a finite"),
    (np.full((3, 4, 2), 1e300), ValueError, "finite number of single precision"),
    (np.full((3, 4, 2), np.nan), ValueError, "no point is visible in any frame"),
    (np.zeros((3, 4, 2), complex), TypeError, "real numbers"),
    (np.zeros((3, 4, 2), bool), TypeError, "its dtype is bool"),
    (np.array([[["a", "b"]]]), TypeError, "real numbers"),
    ([[[1, 2], [3]]], ValueError, "regular array"),
    (None, TypeError, "real numbers"),
    ("hinge.csv", TypeError, "grrl.io.from_csv"),
    (np.full((3, 20, 2), 1e9), ValueError, "is unit= right"),
])
def test_tracks(bad, error, words):
    with pytest.raises(error, match=words):
        grrl.perceive(bad, "mm", 0.7)


def test_half_a_point():
    scene = hinge()
    scene[2, 3, 1] = np.nan
    with pytest.raises(ValueError, match=r"tracks\[2, 3\] has only one coordinate"):
        grrl.perceive(scene, "mm")


@pytest.mark.parametrize("arguments,words", [
    ({"unit": "cm"}, "'px', 'mm', 'm'"),
    ({"noise": 0.0}, "above 0"),
    ({"noise": -1.0}, "noise is -1, but must be"),
    ({"noise": float("nan")}, "noise is nan"),
    ({"noise": float("inf")}, "noise is inf"),
    ({"noise": "some"}, "'auto', a number"),
    ({"noise": 1e7}, "noise is 1e\\+07"),
    ({"profile": "eye"}, "'tracker', 'camera'"),
    ({"profile": "camera"}, "unit='px'"),
])
def test_options(arguments, words):
    with pytest.raises(ValueError, match=words):
        grrl.perceive(hinge(), **{"unit": "mm", **arguments})


def test_noise_that_cannot_be_told():
    with pytest.raises(ValueError, match="too few points"):
        grrl.perceive(hinge(frames=2), "mm")
    with pytest.raises(ValueError, match="do not scatter"):
        grrl.perceive(np.zeros((40, 20, 2)) + np.arange(20)[:, None], "mm")


@SETTINGS
@given(st.data())
def test_any_array(data):
    shape = data.draw(arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=6))
    array = data.draw(arrays.arrays(data.draw(DTYPES), shape))
    try:
        model = grrl.perceive(array, data.draw(st.sampled_from(["px", "mm", "m"])), 0.7)
    except (ValueError, TypeError) as error:
        assert str(error)
    else:
        assert array.ndim == 3 and model.counts["frames"] == shape[0]


@SETTINGS
@given(arrays.arrays(np.float64, st.tuples(st.integers(1, 12), st.integers(1, 30), st.just(2)),
                     elements=st.floats(-300, 300, width=32) | st.just(np.nan)))
def test_any_points(array):
    array[np.isnan(array).any(axis=2)] = np.nan
    try:
        model = grrl.perceive(array, "px", 1.0)
    except ValueError:
        assert np.isnan(array).all() or ((array == 0) | (array == -1)).any()
        return
    assert set(np.concatenate([b.points for b in model.bodies] + [model.background, model.unassigned])
               ) == set(model.ids)
    for joint in model.joints:
        assert joint.motion.shape == (len(array),)


@SETTINGS
@given(st.data())
def test_any_frames(data):
    perception = grrl.Perception("m")
    learner = grrl.Learner("random")
    learner.begin_trial(1)
    for _ in range(data.draw(st.integers(1, 8))):
        n = data.draw(st.integers(0, 300))
        points = data.draw(arrays.arrays(np.float32, (n, 2), fill=st.floats(-1, 1, width=32),
                                         elements=st.floats(width=32)))
        ids = data.draw(arrays.arrays(np.int64, n, elements=st.integers(-2**33, 2**33), unique=True))
        for see in (perception.observe, learner.observe):
            try:
                see(points, ids, pushing=data.draw(st.booleans()))
            except (ValueError, TypeError) as error:
                assert str(error)
    perception.update()
    learner.perceive()
    assert len(learner.model.ids) <= grrl.MAX_FEATURES


def test_huge_frames_are_counted():
    perception = grrl.Perception("mm")
    perception.observe(np.random.default_rng(1).uniform(-500, 500, (20000, 2)))
    assert perception.update().counts["beyond_capacity"] == 20000 - grrl.MAX_FEATURES


@pytest.mark.parametrize("change,words", [
    ({"ids": [1, 1, 2]}, "twice"),
    ({"ids": [2, 1, 3]}, "ascending id"),
    ({"ids": [1, 2]}, "as many points as ids"),
    ({"ids": [1, 2, 2**31]}, "within -2147483648 to 2147483647"),
    ({"ids": [1, 2, 2.5]}, "whole numbers"),
    ({"count": [2, 2]}, "adds up to 4"),
    ({"count": [4, -1]}, "within 0"),
    ({"count": []}, "at least one frame"),
    ({"count": [2**31 - 1, 2**31 - 1]}, "adds up to 4294967294"),
    ({"frames": [5, 5]}, "ascending"),
    ({"frames": [5]}, "ascending"),
    ({"unit": "km"}, "unit must be"),
    ({"pushing": [1, 0]}, "2 booleans"),
    ({"settled": np.zeros(3, bool)}, "2 booleans"),
    ({"xy": np.full((3, 2), np.nan)}, "left out"),
    ({"xy": np.zeros(6)}, r"\(3, 2\)"),
])
def test_recordings(change, words):
    good = {"ids": [1, 2, 3], "xy": np.zeros((3, 2)), "count": [3, 0], "frames": [0, 1], "unit": "mm"}
    grrl.Tracks(**good)
    with pytest.raises(ValueError, match=words):
        grrl.Tracks(**{**good, **change})


def test_ids_of_a_frame():
    perception = grrl.Perception("m")
    with pytest.raises(ValueError, match="ids must differ"):
        perception.observe(np.zeros((2, 2)), [4, 4])
    with pytest.raises(ValueError, match="one for each point"):
        perception.observe(np.zeros((2, 2)), [4])
    perception.observe(np.zeros((0, 2)))
    perception.observe([])
    with pytest.raises(ValueError, match="whole recording"):
        grrl.Perception("m", "auto")


@pytest.mark.parametrize("make,error,words", [
    (lambda: grrl.Learner("best"), ValueError, "'learn', 'paper'"),
    (lambda: grrl.Learner(3), TypeError, "choose"),
    (lambda: grrl.Learner(seed=-1), ValueError, "seed is -1"),
    (lambda: grrl.Learner(seed=1.5), TypeError, "whole number, not float"),
    (lambda: grrl.Learner(seed=2**64), ValueError, "must be from 0"),
    (lambda: grrl.Learner(noise=float("nan")), ValueError, "noise is nan"),
    (lambda: grrl.Learner(capacity=0), ValueError, "capacity is 0"),
    (lambda: grrl.Learner(capacity=10**12), ValueError, "capacity is 1000000000000"),
    (lambda: grrl.Learner(trial_reward=-1), ValueError, "trial_reward"),
    (lambda: grrl.Learner("paper", alpha=7), ValueError, "alpha must be"),
    (lambda: grrl.Learner("paper", rate=1), ValueError, "no parameter rate; it has: alpha"),
    (lambda: grrl.Learner("random", rate=1), ValueError, "it has: none"),
    (lambda: grrl.World("RXR"), ValueError, "X"),
    (lambda: grrl.World("no/such.grrl"), ValueError, "no/such.grrl"),
    (lambda: grrl.World(""), ValueError, "expected|empty|letter|term|:"),
    (lambda: grrl.World(7), TypeError, "such as 'RPRPRPR'"),
    (lambda: grrl.World("RR", noise=1), ValueError, "noise is 1"),
    (lambda: grrl.World("RR", trial=-1), ValueError, "trial is -1"),
    (lambda: grrl.World("RR").begin_push("left"), TypeError, "grrl.Push"),
    (lambda: grrl.World("RR").begin_push(grrl.Push((0, 0), (1,))), ValueError, "x and y"),
    (lambda: grrl.World("RR").begin_push(grrl.Push((0, 0), (float("nan"), 1))), ValueError, "nan"),
    (lambda: grrl.Supervisor("RR").judge("RR"), TypeError, "Learner or a Model"),
    (lambda: grrl.Supervisor("Q"), ValueError, "Q"),
    (lambda: grrl.run_trial(grrl.Learner("random"), "RR", cap=0), ValueError, "cap is 0"),
])
def test_learners_and_worlds(make, error, words):
    with pytest.raises(error, match=words):
        make()


@SETTINGS
@given(st.text(max_size=40))
def test_any_object(text):
    try:
        grrl.Supervisor(text.replace("\0", ""))
    except ValueError as error:
        assert str(error)


@SETTINGS
@given(st.binary(max_size=400))
def test_any_store(store):
    for policy in ("learn", "paper"):
        learner = grrl.Learner(policy)
        with pytest.raises(ValueError, match="load"):
            learner.from_bytes(store)
        assert learner.usage.n == 0
