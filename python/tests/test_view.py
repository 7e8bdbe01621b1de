"""What grrl-view makes of a log: the run, the HTML, the film, and messages for what cannot be shown."""

import csv
import json
import pathlib
import queue
import random
import re
import shutil
import struct
import subprocess
import sys
import time
import zlib

import numpy as np
import pytest
from conftest import ROOT, program
from test_io import event

import grrl
from grrl.view import command, live, movie, pack, read_log, wire
from grrl.view import run as run_module
from grrl.view.run import COMING, OVER, PUSHING, UNDER_WAY, Run, motion_of

OBJECT, SEED, TRIALS = "RPR", 3, 3


@pytest.fixture(scope="session")
def recorded(tmp_path_factory):
    """A folder with run.lcm of grrl-sim, its results.csv and explain.txt of grrl-agent."""
    folder = tmp_path_factory.mktemp("recorded")
    script = ('"$1" --lcm-url "$3" --explain >explain.txt & "$2" --lcm-url "$3" --object "$4" --seed "$5" '
              '--trials "$6" --log run.lcm --results results.csv --quiet --agent-timeout 60; wait')
    done = subprocess.run(
        [ROOT / "tools" / "network", "bash", "-c", script, "bash", program("AGENT"), program("SIM"),
         "udpm://239.255.76.67:7921?ttl=0", OBJECT, str(SEED), str(TRIALS)], cwd=folder, timeout=120,
        capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def log(recorded):
    return recorded / "run.lcm"


def encode(name, **values):
    """A message; what is not named is 0, of a session 7."""
    kind = wire.TYPES[name]
    values = {"session_id": 7, **values}
    given = []
    for member, n in kind.head_members:
        value = values.get(member, 0 if n == 1 else (0,) * n)
        given += [value] if n == 1 else list(value)
    return kind.head.pack(kind.fingerprint, *given) + b"".join(
        np.asarray(values[member], dtype).tobytes() for member, dtype, _ in kind.arrays)


def points(seq, xy, trial=1, phase=1, ack=0, session=7, **more):
    xy = np.asarray(xy, float)
    return encode("points_t", session_id=session, seq=seq, trial_id=trial, phase=phase, ack_cmd_seq=ack,
                  n_points=len(xy), id=np.arange(len(xy)), x=xy[:, 0], y=xy[:, 1], **more)


SQUARE = np.array([(0, 0), (0.1, 0), (0.1, 0.1), (0, 0.1), (0.5, 0.5)])


def model_message(cmd, trial=1, joints=((0, 1, 0),), **more):
    """Two links, of points 0, 1 and 2, 3; point 4 is the table's."""
    n = len(joints)
    zero = np.zeros(n)
    return encode("model_t", **{**dict(
        trial_id=trial, cmd_seq=cmd, n_links=2, n_joints=n, n_features=5, link_number=[1, 2],
        link_x=[0.05, 0.05], link_y=[0, 0.1], link_angle=[0, 0], link_length=[0.1, 0.1],
        link_width=[0.02, 0.02], link_size=[1, 2], joint_a=[j[0] for j in joints],
        joint_b=[j[1] for j in joints], joint_type=[j[2] for j in joints], joint_probability=zero + 0.75,
        joint_x=zero + 0.1, joint_y=zero, joint_angle=zero, joint_lower=zero, joint_upper=zero + 0.5,
        feature_id=range(5), feature_link=[0, 0, 1, 1, -1]), **more})


# --- messages


@pytest.mark.parametrize("name", wire.TYPES)
def test_members_are_those_of_the_definition(name):
    text = (ROOT / "lcmtypes" / f"grrl_{name}.lcm").read_text(encoding="utf-8")
    body = re.sub(r"//.*|const[^;]*;", "", text[text.index("{") + 1:text.rindex("}")])
    assert wire.TYPES[name].members == wire.members_of(body)


def test_choices_are_those_of_the_programs():
    """A constant that the programs accept, such as a new mode, is no damage to the viewer."""
    table = (ROOT / "lcmtypes" / "wire.c").read_text(encoding="utf-8")
    row = r"ONE\(\w, I8, (\w+), GRRL_(\w+)_T_(\w+), GRRL_\w+_T_(\w+)\)"
    compared = set()
    for section in re.split(r"#define \w (?=grrl_)", table)[1:]:
        name = section.split("\n")[0].removeprefix("grrl_")
        for member, owner, low, high in re.findall(row, section):
            if name not in wire.TYPES or member not in wire.TYPES[name].ranges:
                continue
            text = (ROOT / "lcmtypes" / f"grrl_{owner.lower()}_t.lcm").read_text(encoding="utf-8")
            value = {c: int(v) for c, v in re.findall(r"const int8_t (\w+) = (-?\d+)", text)}
            assert wire.TYPES[name].ranges[member] == (value[low], value[high]), (name, member)
            compared.add((name, member))
    assert {("points_t", "mode"), ("points_t", "phase"), ("decision_t", "reason")} <= compared


def test_what_is_damaged_is_refused():
    good = model_message(1)
    assert wire.decode("model_t", good)["joint_probability"] == [np.float32(0.75)]
    for bad in (dict(joints=((0, 0, 0),)), dict(joints=((0, 2, 0),)), dict(joints=((0, 1, 2),)),
                dict(feature_link=[0, 0, 1, 2, -1]), dict(joint_probability=[np.nan]),
                dict(link_x=[np.inf, 0]), dict(joint_x=[np.nan]), dict(session_id=0)):
        with pytest.raises(ValueError, match="model_t"):
            wire.decode("model_t", model_message(1, **bad))
    with pytest.raises(ValueError, match="too many"):
        wire.decode("model_t", good + b"\0")
    with pytest.raises(wire.OtherSchema):
        wire.decode("points_t", good)
    with pytest.raises(ValueError, match="n_points is 257"):
        wire.decode("points_t", points(1, np.zeros((257, 2))))


def test_messages_cut_and_changed_at_each_byte():
    """Whatever comes is taken or counted; nothing is raised."""
    rng = random.Random(5)
    messages = [("GRRL_POINTS", points(1, SQUARE)), ("GRRL_MODEL", model_message(0)),
                ("GRRL_DECISION", encode("decision_t", trial_id=1, cmd_seq=1)),
                ("GRRL_PUSH_COMMAND", encode("push_command_t", plant_session_id=7, trial_id=1, cmd_seq=1,
                                             kind=1)),
                ("GRRL_PUSH_STATUS", encode("push_status_t", trial_id=1, cmd_seq=1, state=2, reason=1)),
                ("GRRL_TRIAL", encode("trial_t", trial_id=1, phase=1, outcome=1)),
                ("GRRL_STOP", encode("stop_t"))]
    for place, (channel, data) in enumerate(messages):
        for at in range(len(data)):
            run = Run()
            for before in messages[:place]:
                run.add(*before, 1)
            assert not run.add(channel, data[:at], 1)
            assert run.refused[channel] + run.other_schema[channel] == 1
            changed = bytearray(data)
            changed[at] = rng.randrange(256)
            run.add(channel, bytes(changed), 1)
            for _ in pack.pack(run, "x"):
                break


# --- the run


def test_run_is_what_the_programs_say(recorded, log):
    run = read_log(log)
    with open(recorded / "results.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(t.id, t.pushes, t.outcome) for t in run.trials] == [
        (int(r["trial"]), int(r["pushes"]), r["outcome"]) for r in rows]
    explained = (recorded / "explain.txt").read_text(encoding="utf-8")
    assert [m.term for m in run.models] == re.findall(r"after push \d+: (.*?)(?:; .*)?$", explained, re.M)
    assert [f"f{p.link} at {p.direction} deg, {p.why}; phi {p.phi:.2f}" for p in run.pushes] == re.findall(
        r"push \d+: (f.*), last reward", explained)
    rewards = [float(x) for x in re.findall(r"push \d+: f.*, last reward (.*)", explained)]
    for before, after in zip(rewards[1:], run.pushes[:-1]):
        assert after.reward is None or after.reward == pytest.approx(before)
    assert all(p.result in ("reached", "missed", "blocked", "timeout") for p in run.pushes)
    assert not run.warnings()


def test_stages_of_a_push(log):
    run = read_log(log)
    for number, push in enumerate(run.pushes):
        stages = [f.stage for f in run.frames if f.push == number]
        assert stages == sorted(stages) and set(stages) == {COMING, UNDER_WAY, OVER}
        coming = next(f for f in run.frames if f.push == number)
        assert run.models[coming.model].cmd == push.cmd - 1
        assert push.link in [link.n for link in run.models[coming.model].links]
    times = [f.t for f in run.frames]
    assert all(b > a for a, b in zip(times, times[1:]))


def test_motion_follows_the_points():
    run = Run()
    run.add("GRRL_POINTS", points(1, SQUARE), 1)
    run.add("GRRL_MODEL", model_message(0), 2)
    angle, shift = 0.3, np.array([0.2, -0.1])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    now = SQUARE.copy()
    now[2:4] = SQUARE[2:4] @ turn.T + shift
    run.add("GRRL_POINTS", points(2, now, phase=PUSHING, ack=1), 3)
    assert run.frames[0].model == run.frames[1].model == 0
    assert run.frames[1].motion == pytest.approx(np.array([(0, 0, 0), (*shift, angle)]), abs=1e-6)
    assert run.models[0].term == "D(lb, R(L(s, f1), L(l, f2)))"
    one = np.array([0]), now[:1].astype(np.float32)
    assert not motion_of(run.models[0], *one).any()


def test_sessions_repetition_and_strangers():
    run = Run()
    assert run.add("GRRL_POINTS", points(1, SQUARE), 0)
    assert not run.add("GRRL_POINTS", points(1, SQUARE), 10)  # repeated
    assert not run.add("GRRL_POINTS", points(9, SQUARE, session=8), 20)  # a stranger
    assert run.foreign == 1 and "other sessions" in run.warnings()[0]
    assert not run.add("GRRL_PUSH_COMMAND", encode("push_command_t", plant_session_id=8, kind=1,
                                                   cmd_seq=1, trial_id=1), 30)
    assert run.add("GRRL_POINTS", points(1, SQUARE, session=8), 2_000_000)  # the first is silent
    assert [t.id for t in run.trials] == [1, 1]
    assert run.add("GRRL_POINTS", points(1, SQUARE, session=9), 1)  # another log, appended


def test_tracker_that_knows_no_pushes():
    run = Run()
    run.add("GRRL_POINTS", points(1, SQUARE, trial=0, phase=0), 1)
    run.add("GRRL_PUSH_COMMAND", encode("push_command_t", session_id=5, plant_session_id=7, trial_id=0,
                                        cmd_seq=1, kind=1, start=(0, 0), end=(1, 0)), 2)
    assert run.frames[-1].stage == COMING and run.pushes[0].end == (1, 0)
    status = dict(session_id=7, agent_session_id=5, trial_id=0, cmd_seq=1)
    run.add("GRRL_PUSH_STATUS", encode("push_status_t", **status, state=1), 3)
    run.add("GRRL_POINTS", points(2, SQUARE, trial=0, phase=0), 4)
    assert run.frames[-1].stage == UNDER_WAY
    run.add("GRRL_PUSH_STATUS", encode("push_status_t", **status, state=2, reason=1), 5)
    assert run.frames[-1].stage == OVER and run.pushes[0].result == "reached"
    assert run.trials[0].pushes == 1


def add_all(run, log):
    data = pathlib.Path(log).read_bytes()
    run_module.add_log(run, data)
    return run


def test_a_long_live_run_drops_its_beginning(log):
    whole, short = read_log(log), add_all(Run(max_frames=100), log)
    assert len(short.frames) <= 100 < len(whole.frames) and short.dropped
    assert short.trials == whole.trials
    for a, b in zip(reversed(short.frames), reversed(whole.frames)):
        assert a.t == b.t and a.stage == b.stage
        assert a.model < 0 or short.models[a.model].term == whole.models[b.model].term
        assert a.push < 0 or short.pushes[a.push].why == whole.pushes[b.push].why


def test_a_world_faster_than_time_is_thinned(log):
    run = add_all(Run(least_gap_us=10**9), log)
    whole = read_log(log)
    assert len(run.frames) < len(whole.frames) / 3
    assert [m.term for m in run.models] == [m.term for m in whole.models]
    assert run.trials == whole.trials


def test_one_trial(log):
    whole = read_log(log)
    run = whole.only(2)
    assert {f.trial for f in run.frames} == {1} and run.frames[0].t == 0
    assert len(run.models) == sum(m.trial == 1 for m in whole.models)
    last = [f for f in whole.frames if f.trial == 1][-1]
    assert run.models[run.frames[-1].model] is whole.models[last.model]
    assert run.pushes[run.frames[-1].push] is whole.pushes[last.push]
    with pytest.raises(ValueError, match="no trial 9 .*there are 1, 2, 3"):
        whole.only(9)


def test_snippet_of_the_page(log, tmp_path):
    text = (ROOT / "docs" / "view.md").read_text(encoding="utf-8")
    block, = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    (tmp_path / "run.lcm").symlink_to(log)
    done = subprocess.run([sys.executable, "-W", "error", "-c", block], cwd=tmp_path, capture_output=True,
                          text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "'discovered'" in done.stdout and "D(lb, " in done.stdout


# --- what the page gets


def unpack(data):
    """As data.js does it."""
    raw = zlib.decompress(data)
    n, = struct.unpack_from("<I", raw)
    header = json.loads(raw[4:4 + n])
    at, columns = 4 + n, {}
    for name, size in header["columns"]:
        planes = np.frombuffer(raw, np.uint8, 4 * size, at).reshape(4, size)
        folded = np.ascontiguousarray(planes.T).view("<u4").ravel()
        columns[name] = (folded >> 1).astype(np.int32) ^ -(folded & 1).astype(np.int32)
        at += 4 * size
    assert at == len(raw)
    return header, columns


def test_pack_holds_the_run(log):
    run = read_log(log)
    header, columns = unpack(pack.pack(run, "x"))
    count = np.cumsum(columns["n"])
    assert count.tolist() == [f.ids.size for f in run.frames]
    x, before, at = columns["x"], np.empty(0, int), 0
    for frame, n in zip(run.frames, count):
        row = x[at:at + n] + (before if before.size == n else 0)
        assert np.abs(row * header["length_m"] - frame.xy[:, 0]).max() <= pack.LENGTH_M / 2 + 1e-6
        before, at = row, at + n
    assert [m["term"] for m in header["models"]] == [m.term for m in run.models]
    assert "truth" not in header and "truth" not in columns


def test_html_is_one_file_without_a_network(tmp_path, log, capsys):
    out = tmp_path / "out.html"
    named = tmp_path / "a<b>&.lcm"
    shutil.copy(log, named)
    assert command.main(["--html", str(out), str(named)]) == 0
    assert capsys.readouterr().out == f"{out}\n"
    text = out.read_text(encoding="utf-8")
    assert "<title>a&lt;b>&amp;.lcm - grrl-view</title>" in text
    assert not re.search(r"https?://|src=|href=|@[A-Z]+@|@import|url\(", text)
    assert "default-src 'none'" in text
    assert len(text) < 2_000_000
    assert not out.with_name("out.html.new").exists()


# --- the truth of the simulator


def test_truth_is_the_world_again(log):
    pytest.importorskip("grrl._native").HAS_WORLD or pytest.skip("needs Box2D")
    from grrl.view.truth import truth_of
    run = read_log(log)
    truth = truth_of(run, OBJECT, SEED)
    assert truth.joints == grrl.Supervisor(OBJECT).joints and len(truth.poses) == len(run.frames)
    moved = [np.abs(b - a).max() for a, b in zip(truth.poses, truth.poses[1:])]
    assert max(moved) > 0.01
    link_of = grrl.Supervisor.link_of_point(grrl.World(OBJECT, SEED, run.trials[-1].id))
    frame, poses = run.frames[-1], truth.poses[-1]
    for link, (length, width) in enumerate(truth.sizes):
        offset = frame.xy[link_of[frame.ids] == link] - poses[link, :2]
        c, s = np.cos(poses[link, 2]), np.sin(poses[link, 2])
        inside = np.abs(offset @ np.array([[c, -s], [s, c]])) < np.array([length, width]) / 2 + 0.004
        assert inside.all()
    for other in ((OBJECT, SEED + 1), ("RRR", SEED)):
        with pytest.raises(ValueError, match="this log is not one of grrl-sim with --object"):
            truth_of(run, *other)


# --- films


def test_film(tmp_path, log, capsys):
    if shutil.which("ffmpeg") is None or shutil.which("ffprobe") is None:
        pytest.skip("needs ffmpeg: tools/setup view")
    out = tmp_path / "film.mp4"
    assert command.main(["--mp4", str(out), "--trial", "1", "--speed", "20", str(log)]) == 0
    assert capsys.readouterr().out == f"{out}\n"
    told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                           "stream=width,height,nb_read_frames,codec_name", "-of", "json", out],
                          capture_output=True, check=True, timeout=60)
    stream, = json.loads(told.stdout)["streams"]
    run = read_log(log).only(1)
    expected = len(np.arange(run.frames[0].t, run.frames[-1].t + 1, 20 / 30))
    assert (stream["codec_name"], stream["width"], stream["height"]) == ("h264", 1280, 720)
    assert int(stream["nb_read_frames"]) == expected


def test_picture_of_a_film_has_the_links(log):
    pytest.importorskip("matplotlib")
    run = read_log(log)
    number = max(range(len(run.frames)), key=lambda i: (
        len(run.models[run.frames[i].model].links) if run.frames[i].model >= 0 else 0))
    picture = np.asarray(movie.Film(run, "x").draw(number))[:, :, :3].astype(int)
    for link in run.models[run.frames[number].model].links:
        colour = grrl.plot.colour_of(link.n - 1)
        rgb = [int(colour[i:i + 2], 16) for i in (1, 3, 5)]
        assert (np.abs(picture - rgb).max(axis=2) < 12).sum() > 50


def test_film_without_ffmpeg(tmp_path, log, capsys, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert command.main(["--mp4", str(tmp_path / "film.mp4"), str(log)]) == 1
    assert "apt-get install ffmpeg" in capsys.readouterr().err


# --- what cannot be shown


def other_points():
    data = bytearray(points(1, SQUARE))
    data[3] ^= 1  # the fingerprint of another version
    return bytes(data)


@pytest.mark.parametrize("data,message", [
    (b"", "the log is empty"),
    (b"frame,point,x,y\n0,1,2,3\n", "this is no LCM log"),
    (event(1, b"abc", b"CAMERA") + event(2, b"abc", b"CAMERA"), "this one has CAMERA (2)"),
    (event(1, b"abc", b"GRRL_IMAGE"), "pictures only"),
    (event(1, other_points()), "1 messages on GRRL_POINTS are of another version of grrl"),
    (event(1, points(1, SQUARE)[:-1]), "1 damaged messages on GRRL_POINTS"),
])
def test_logs_that_cannot_be_shown(tmp_path, data, message, capsys):
    path = tmp_path / "bad.lcm"
    path.write_bytes(data)
    assert command.main([str(path), "--html", str(tmp_path / "out.html")]) == 1
    error = capsys.readouterr().err
    assert error.startswith("grrl-view: ") and str(path) in error and message in error
    assert not (tmp_path / "out.html").exists()


def test_files_that_are_not_there(tmp_path, log, capsys):
    assert command.main([str(tmp_path / "none.lcm")]) == 1
    assert "none.lcm" in capsys.readouterr().err
    assert command.main([str(tmp_path)]) == 1
    assert command.main([str(log), "--html", str(tmp_path / "no" / "out.html")]) == 1
    assert "out.html" in capsys.readouterr().err
    assert command.main([str(tmp_path), "--live", "--no-browser"]) == 1
    assert "is a folder" in capsys.readouterr().err


def test_damaged_log_is_shown_with_a_warning(tmp_path, log, capsys):
    data = bytearray(log.read_bytes())
    data[50_000:50_400] = bytes(400)
    path = tmp_path / "damaged.lcm"
    path.write_bytes(data[:-5])
    assert command.main([str(path), "--html", str(tmp_path / "out.html")]) == 0
    assert "the log is damaged in 2 places" in capsys.readouterr().err


def test_log_cut_at_each_byte(tmp_path):
    whole = event(1, points(1, SQUARE)) + event(2, points(2, SQUARE))
    path = tmp_path / "cut.lcm"
    for n in range(1, len(whole)):
        path.write_bytes(whole[:n])
        try:
            assert len(read_log(path).frames) == 1
        except ValueError:
            assert n < len(whole) / 2


# --- the command line


@pytest.mark.parametrize("arguments,message", [
    ([], "a LOG is missing, or --live"),
    (["a", "b"], "unrecognized"),
    (["--live", "--html", "x"], "--html needs a complete LOG"),
    (["--live", "--mp4", "x"], "--mp4 needs a complete LOG"),
    (["--live", "--truth", "RPR"], "--truth needs a complete LOG"),
    (["a", "--lcm-url", "x"], "--lcm-url and LOG contradict"),
    (["a", "--live", "--lcm-url", "x"], "--lcm-url and LOG contradict"),
    (["a", "--seed", "1"], "--seed needs --truth"),
    (["a", "--speed", "2"], "--speed needs --mp4"),
    (["a", "--html", "x", "--port", "1"], "need a page that is shown"),
    (["a", "--port", "70000"], "must be a whole number from 0 to 65535"),
    (["a", "--trial", "one"], "must be a whole number from 0"),
    (["a", "--mp4", "x", "--speed", "nan"], "must be a number from 0.1 to 100"),
    (["a", "--no-such"], "unrecognized"),
])
def test_wrong_command_lines(arguments, message, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(arguments)
    assert ended.value.code == 2
    assert message in capsys.readouterr().err


def test_help_and_version(capsys):
    for option in ("--help", "--version"):
        with pytest.raises(SystemExit) as ended:
            command.main([option])
        assert ended.value.code == 0
    out = capsys.readouterr().out
    assert out.endswith(f"grrl-view {grrl.VERSION}\n")
    page = (ROOT / "docs" / "view.md").read_text(encoding="utf-8")
    for option in re.findall(r"^  (--[a-z0-9-]+)", out, re.M):
        assert f"`{option}" in page or option in ("--help", "--version"), option


def test_without_aiohttp(log, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    monkeypatch.delitem(sys.modules, "grrl.view.server", raising=False)
    monkeypatch.delattr(grrl.view, "server", raising=False)
    assert command.main([str(log), "--no-browser"]) == 1
    assert "pip install 'grrl[view]'" in capsys.readouterr().err


def test_without_lcm_and_without_a_bus(capsys, monkeypatch):
    pytest.importorskip("aiohttp")
    pytest.importorskip("lcm")
    assert command.main(["--live", "--lcm-url", "nothing://"]) == 1
    assert "no LCM at nothing://" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "lcm", None)
    assert command.main(["--live"]) == 1
    assert "--live needs the package lcm" in capsys.readouterr().err


# --- a log that grows


def test_growing_log_gives_every_event_once(tmp_path, log):
    data = log.read_bytes()[:200_000]
    path = tmp_path / "growing.lcm"
    source = live.GrowingLog(str(path))
    source.start()
    rng, at, heard = random.Random(2), 0, []
    with open(path, "wb", buffering=0) as file:
        while at < len(data):
            n = rng.choice((1, 27, 28, 29, 5000, 60_000))
            file.write(data[at:at + n])
            at += n
            if rng.random() < 0.3:
                time.sleep(0.01)
    whole = data[:live.whole_events(data)]
    expected = [(e[0].decode(), e[1], e[2]) for e in grrl.io._events(whole)]
    while len(heard) < len(expected):
        heard.append(source.heard.get(timeout=30))
    with pytest.raises(queue.Empty):
        source.heard.get(timeout=0.2)
    source.end()
    assert heard == expected and not source.over


def test_damage_in_a_growing_log_is_skipped():
    good = event(1, points(1, SQUARE))
    data = good + b"\xed\xa1\xda\x01" + b"x" * 40 + good + good[:-1]
    n = live.whole_events(data)
    assert n == len(data) - len(good) + 1
    assert [e is not None for e in grrl.io._events(data[:n])].count(True) == 2
