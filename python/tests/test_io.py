"""Readers give the tracks that other programs wrote."""

import json
import os
import struct

import numpy as np
import pandas as pd
import pytest
from conftest import hinge, run, write_csv
from test_perceive import assert_same

import grrl
from grrl import io


def with_gaps():
    scene = hinge()
    scene[3, 4] = np.nan
    scene[10:, 7] = np.nan
    return scene


def assert_tracks(tracks, scene, unit):
    array, ids = tracks.to_array()
    assert tracks.unit == unit
    np.testing.assert_allclose(array, scene.astype(np.float32), rtol=1e-6)
    assert array.shape[1] == ids.size


def test_opencv():
    scene = with_gaps()
    assert_tracks(io.from_opencv(scene), scene, "px")
    assert_tracks(io.from_opencv(scene[:, :, None, :], unit="mm"), scene, "mm")
    assert_tracks(io.from_opencv(list(scene[:, :, None, :])), scene, "px")


def test_opencv_status_loses_a_point_for_good():
    scene = hinge()
    status = np.ones(scene.shape[:2], np.uint8)
    status[10, 3] = 0
    scene_seen = scene.copy()
    scene_seen[10:, 3] = np.nan
    assert_tracks(io.from_opencv(scene, status[:, :, None]), scene_seen, "px")
    with pytest.raises(ValueError, match="status must be whole numbers of shape"):
        io.from_opencv(scene, status[:5])


def deeplabcut(scene, likelihood):
    columns = pd.MultiIndex.from_product(
        [["net"], [f"part{i}" for i in range(scene.shape[1])], ["x", "y", "likelihood"]],
        names=["scorer", "bodyparts", "coords"])
    return pd.DataFrame(np.concatenate([scene, likelihood[:, :, None]], 2).reshape(len(scene), -1),
                        columns=columns)


def test_deeplabcut(tmp_path):
    scene, likelihood = hinge(), np.ones((40, 20))
    likelihood[5, 2] = 0.59
    table = deeplabcut(scene, likelihood)
    scene[5, 2] = np.nan
    assert_tracks(io.from_deeplabcut(table), scene, "px")
    table.to_csv(tmp_path / "dlc.csv")
    assert_tracks(io.from_deeplabcut(tmp_path / "dlc.csv"), scene, "px")
    assert_tracks(io.from_deeplabcut(table.droplevel(0, axis=1)), scene, "px")
    write_csv(tmp_path / "plain.csv", scene)
    with pytest.raises(ValueError, match="scorer, bodyparts and coords"):
        io.from_deeplabcut(tmp_path / "plain.csv")
    with pytest.raises(ValueError, match="several header rows"):
        io.from_deeplabcut(pd.read_csv(tmp_path / "plain.csv"))


def long_table(scene, point):
    frame, index = np.indices(scene.shape[:2])
    table = pd.DataFrame({"y": scene[..., 1].ravel(), "x": scene[..., 0].ravel(),
                          point: index.ravel(), "frame": frame.ravel(), "mass": 1.0})
    return table.dropna().sample(frac=1, random_state=3)


def test_trackpy():
    scene = with_gaps()
    assert_tracks(io.from_trackpy(long_table(scene, "particle")), scene, "px")
    with pytest.raises(ValueError, match="trackpy.link"):
        io.from_trackpy(long_table(scene, "point"))


def test_dataframe_columns():
    scene = with_gaps()
    table = long_table(scene, "point").rename(columns={"x": "x_px", "y": "y_px"})
    assert_tracks(grrl.Tracks.from_dataframe(table), scene, "px")
    table["visible"] = 1
    table.iloc[0, table.columns.get_loc("visible")] = 0
    assert grrl.Tracks.from_dataframe(table).ids.size == len(table) - 1
    with pytest.raises(ValueError, match="no column x; it has"):
        grrl.Tracks.from_dataframe(table.drop(columns=["x_px"]))
    with pytest.raises(ValueError, match="there twice"):
        grrl.Tracks.from_dataframe(pd.concat([table, table[:1]]))
    with pytest.raises(TypeError, match="must hold numbers"):
        grrl.Tracks.from_dataframe(table.assign(x_px="left"))


def test_tapir():
    scene = with_gaps()
    visible = ~np.isnan(scene[..., 0]).T
    filled = np.nan_to_num(scene).transpose(1, 0, 2)
    assert_tracks(io.from_tapir(filled, visible), scene, "px")
    assert_tracks(io.from_tapir(filled / (640, 480), visible, (640, 480)), scene, "px")
    with pytest.raises(ValueError, match="visible must be booleans of shape"):
        io.from_tapir(filled, visible.T)


def test_csv_errors_name_the_place(tmp_path):
    path = tmp_path / "bad.csv"
    path.write_text("frame,point,x,y\n0,1,one,2\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"bad.csv:2:5: .*finite number"):
        io.from_csv(path)
    with pytest.raises(FileNotFoundError, match="none.csv"):
        io.from_csv(tmp_path / "none.csv")
    with pytest.raises(ValueError, match="null character"):
        io.from_csv(f"{path}\0more")
    with pytest.raises(TypeError):
        io.from_csv(3)
    odd = os.fsdecode(bytes(tmp_path) + b"/\xff.csv")
    with pytest.raises(FileNotFoundError):
        io.from_csv(odd)
    write_csv(odd, hinge())
    assert io.from_csv(odd).count.size == 40
    with pytest.raises(TypeError, match="grrl.io.from_csv"):
        grrl.perceive(str(path), "mm")


# --- LCM logs -----------------------------------------------------------------------------------


def event(number, data, channel=b"GRRL_POINTS"):
    return struct.pack(">4sqqII", b"\xed\xa1\xda\x01", number, number, len(channel),
                       len(data)) + channel + data


def points_message(seq, trial, phase, points, session=7):
    ids = np.flatnonzero(~np.isnan(points[:, 0]))
    head = struct.pack(">QqqqiiqbbI", io._FINGERPRINT, 0, session, seq, trial, 0, 0, 1, phase, len(ids))
    return head + ids.astype(">i4").tobytes() + points[ids].astype(">f4").T.tobytes()


def log_of(scene, session=7, first=1):
    """Two trials: the first at rest only; the second is at rest, pushed, at rest."""
    messages, seq = [], first
    for _ in range(10):
        messages.append(points_message(seq, 1, 1, scene[0], session))
        seq += 1
    phases = [1] * 9 + [3] + [2] * len(scene) + [1] * 9 + [3]
    frames = [scene[0]] * 10 + list(scene) + [scene[-1]] * 10
    for phase, points in zip(phases, frames):
        messages.append(points_message(seq, 2, phase, points, session))
        seq += 1
    return messages


def write_log(path, messages):
    path.write_bytes(b"".join(event(i + 1, m) for i, m in enumerate(messages)))


def scene_m():
    return hinge(noise=0.5) / 1000


@pytest.mark.parametrize("trial", [None, 1, 2])
def test_log_as_the_program_reads_it(tmp_path, trial):
    path = tmp_path / "run.lcm"
    write_log(path, log_of(scene_m()))
    given = [] if trial is None else ["--trial", trial]
    answer = json.loads(run("PERCEIVE", "--json", "--log", path, *given))
    model = grrl.perceive(io.from_lcm_log(path, trial), noise=None)
    assert_same(model, answer)
    assert len(model.joints) == (trial != 1)


def test_log_of_two_senders(tmp_path):
    path = tmp_path / "run.lcm"
    one, two = log_of(scene_m()), log_of(drawer_m(), session=9)
    for messages in (one + two, [m for both in zip(one, two) for m in both][:-1]):
        write_log(path, messages)
        answer = json.loads(run("PERCEIVE", "--json", "--log", path))
        tracks = io.from_lcm_log(path)
        assert "2 sessions" in tracks.warnings[0]
        assert_same(grrl.perceive(tracks, noise=None), answer)


def drawer_m():
    scene = hinge(noise=0.5, turn=0.0) / 1000
    scene[:, 10:, 0] += np.linspace(0, 0.06, len(scene))[:, None]
    return scene


def test_damaged_log(tmp_path):
    path = tmp_path / "run.lcm"
    write_log(path, log_of(scene_m()))
    whole = bytearray(path.read_bytes())
    whole[5000:5100] = bytes(100)
    path.write_bytes(whole[:-3])
    tracks = io.from_lcm_log(path)
    assert "damaged in 2 places" in " ".join(tracks.warnings)
    assert len(grrl.perceive(tracks, noise=None).joints) == 1
    for bad in (b"", b"no log", whole[:20], event(1, b"short"), event(1, b"x", b"OTHER")):
        path.write_bytes(bad)
        with pytest.raises(ValueError, match="GRRL_POINTS"):
            io.from_lcm_log(path)


def test_log_cut_at_each_byte(tmp_path):
    path = tmp_path / "run.lcm"
    write_log(path, [points_message(i, 1, 1, scene_m()[0][:3]) for i in (1, 2)])
    whole = path.read_bytes()
    for n in range(len(whole)):
        path.write_bytes(whole[:n])
        try:
            assert io.from_lcm_log(path).count.size == 1
        except ValueError:
            assert n < len(whole) / 2
