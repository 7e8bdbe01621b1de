"""What the page of grrl-view shows in headless Chromium, from a file and live."""

import asyncio
import base64
import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import ROOT, program
from test_view import OBJECT, SEED, SQUARE, log, points, recorded  # noqa: F401 (log and recorded: fixtures)

import grrl
from grrl.plot import colour_of
from grrl.view import command, pack, read_log
from grrl.view.run import COMING

aiohttp = pytest.importorskip("aiohttp", reason="needs the package aiohttp")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
if CHROMIUM is None:
    pytest.skip("needs Chromium: tools/setup view", allow_module_level=True)
_WAIT_S = 60


class Browser:
    """Headless Chromium, driven through its debugging port."""

    def __init__(self, folder, before=()):
        self.loop = asyncio.new_event_loop()
        self.errors = []
        self._number = 0
        port_file = folder / "profile" / "DevToolsActivePort"
        self.process = subprocess.Popen(
            [*before, CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
             "--window-size=1280,880", "--remote-debugging-port=0", f"--user-data-dir={port_file.parent}",
             "--no-first-run", "--disable-background-networking", "about:blank"],
            stderr=subprocess.DEVNULL, start_new_session=True)
        wait(lambda: port_file.exists() and port_file.read_text().count("\n"), "Chromium")
        self.port = int(port_file.read_text().split()[0])
        self._run(self._open())

    def _run(self, task):
        return self.loop.run_until_complete(asyncio.wait_for(task, _WAIT_S))

    async def _open(self):
        self.session = aiohttp.ClientSession()
        async with self.session.get(f"http://127.0.0.1:{self.port}/json/list") as answer:
            pages = [page for page in await answer.json() if page["type"] == "page"]
        self.socket = await self.session.ws_connect(pages[0]["webSocketDebuggerUrl"],
                                                    max_msg_size=1 << 26)
        for domain in ("Page", "Runtime", "Log"):
            await self._ask(domain + ".enable")

    async def _ask(self, method, **parameters):
        self._number += 1
        number = self._number
        await self.socket.send_json({"id": number, "method": method, "params": parameters})
        while True:
            message = await self.socket.receive_json()
            if message.get("method") == "Runtime.exceptionThrown":
                self.errors.append(json.dumps(message["params"]))
            if message.get("method") == "Log.entryAdded" and message["params"]["entry"]["level"] == "error":
                self.errors.append(json.dumps(message["params"]))
            if message.get("id") == number:
                assert "error" not in message, message
                return message["result"]

    def ask(self, method, **parameters):
        return self._run(self._ask(method, **parameters))

    def open(self, url):
        self.errors.clear()
        self.ask("Page.navigate", url=url)
        wait(lambda: self.value("document.body && document.body.dataset.ready") == "1", "the page")

    def value(self, expression):
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def text(self, id):
        return self.value(f"document.getElementById('{id}').innerText")

    def press(self, key, shift=False):
        self.value(f"document.dispatchEvent(new KeyboardEvent('keydown', {{key: {json.dumps(key)}, "
                   f"shiftKey: {json.dumps(shift)}, bubbles: true}})), 0")

    def screenshot(self, path):
        data = self.ask("Page.captureScreenshot", format="png")["data"]
        pathlib.Path(path).write_bytes(base64.b64decode(data))

    def close(self):
        with contextlib.suppress(Exception):
            self._run(self.session.close())
        self.loop.close()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


def wait(condition, what, seconds=_WAIT_S):
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, f"{what} does not come"
        time.sleep(0.05)
    return found


class Viewer:
    """grrl-view with its page, until it is stopped."""

    def __init__(self, *arguments):
        self.began = time.monotonic()
        self.process = subprocess.Popen([sys.executable, "-m", "grrl.view", "--no-browser",
                                         *map(str, arguments)], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().split()[0]

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(_WAIT_S)


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    browser = Browser(tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()


@pytest.fixture(scope="module")
def html(tmp_path_factory, log):
    path = tmp_path_factory.mktemp("html") / "out.html"
    path.write_text(pack.page(pack.pack(read_log(log), "run.lcm"), "run.lcm"), encoding="utf-8")
    return path.as_uri()


def rgb(colour):
    return [int(colour[i:i + 2], 16) for i in (1, 3, 5)]


def pixels_of(browser, folder, colour):
    """How many pixels of the table's screenshot have about a colour."""
    from PIL import Image

    browser.screenshot(folder / "shot.png")
    ratio = browser.value("devicePixelRatio")
    box = browser.value("(() => { const r = document.getElementById('table').getBoundingClientRect(); "
                        "return [r.left, r.top, r.right, r.bottom]; })()")
    picture = Image.open(folder / "shot.png").convert("RGB").crop([round(x * ratio) for x in box])
    return int((np.abs(np.asarray(picture).astype(int) - rgb(colour)).max(axis=2) < 30).sum())


def at_point(browser, frame, i):
    """The pixel of the canvas at point i of the frame that is shown."""
    x, y = frame.xy[i]
    return browser.value(
        f"(() => {{ const c = document.getElementById('table'), p = state.projection, "
        f"r = devicePixelRatio; return Array.from(c.getContext('2d').getImageData("
        f"Math.round(p.x({x}) * r), Math.round(p.y({y}) * r), 1, 1).data).slice(0, 3); }})()")


def assert_shows(browser, run, number):
    """Points, joints, texts of frame `number` of a run."""
    frame = run.frames[number]
    model = run.models[frame.model]
    assert browser.value("document.getElementById('table').getAttribute('aria-label')") == (
        f"{frame.ids.size} points, {len(model.links)} links, {len(model.joints)} joints")
    assert browser.text("term") == model.term
    rows = browser.value("Array.from(document.querySelectorAll('#joints li'), (r) => r.innerText)")
    rows = [row for row in rows if row != "none yet"]
    assert len(rows) == len(model.joints)
    for row, joint in zip(rows, model.joints):
        words = row.split()
        assert words[:4] == [f"f{model.links[joint.a].n}", f"f{model.links[joint.b].n}", joint.type,
                             f"{joint.p:.3f}"]
    push = run.pushes[frame.push]
    assert browser.text("push-what") == f"f{push.link} at {push.direction}\u00b0"
    assert browser.text("push-why") == push.why
    legend = browser.text("legend").split()
    assert [f"f{link.n}" for link in model.links] == [w for w in legend if re.fullmatch(r"f\d+", w)]


# --- from a file


def test_frame_with_joints(browser, html, log, tmp_path):
    run = read_log(log)
    number = max(i for i, f in enumerate(run.frames) if f.stage == COMING
                 and len(run.models[f.model].joints) > 0)
    browser.open(html)
    browser.value(f"seek({number}), 0")
    assert_shows(browser, run, number)
    assert browser.text("push-title").startswith("Next push")
    frame, model = run.frames[number], run.models[run.frames[number].model]
    link_of = dict(zip(model.ids.tolist(), model.link_of.tolist()))
    shown = wrong = 0
    for i, id in enumerate(frame.ids.tolist()):
        link = link_of.get(id, -2)
        if link >= 0:
            off = np.abs(np.array(at_point(browser, frame, i))
                         - rgb(colour_of(model.links[link].n - 1))).max()
            shown, wrong = shown + 1, wrong + (off > 40)
    assert shown > 10 and wrong < shown / 4  # names, pivots and the push lie over some
    for link in model.links:
        assert pixels_of(browser, tmp_path, colour_of(link.n - 1)) > 60
    assert pixels_of(browser, tmp_path, "#222222") > 15  # pivots and axes
    assert pixels_of(browser, tmp_path, "#c1121f") > 60  # the push
    assert pixels_of(browser, tmp_path, "#c2188b") == 0  # no truth unless it is asked for
    assert browser.value("document.getElementById('truth-mark').offsetParent") is None
    assert browser.errors == []


def test_points_move_with_the_time(browser, html, log):
    run = read_log(log)
    browser.open(html)
    for number in range(0, len(run.frames), len(run.frames) // 7):
        browser.value(f"seek({number}), 0")
        shown = browser.value("(() => { const f = state.run.frames[state.at]; return [Array.from(f.ids), "
                              "Array.from(f.x, (x) => x * state.run.length_m), Array.from(f.motion)]; })()")
        frame = run.frames[number]
        assert shown[0] == frame.ids.tolist()
        assert np.abs(np.array(shown[1]) - frame.xy[:, 0]).max() < 0.0002
        assert np.abs(np.array(shown[2]) - pack._motion(frame)).max(initial=0) == 0


def test_keys(browser, html, log):
    run = read_log(log)
    browser.open(html)

    def at():
        return int(browser.value("document.body.dataset.at"))

    browser.press("Home")
    assert at() == 0
    browser.press("ArrowRight")
    assert at() == 1
    decided = [i for i, f in enumerate(run.frames) if f.stage == COMING]
    for expected in decided[:3]:
        browser.press("ArrowRight", shift=True)
        assert at() == expected
    browser.press("ArrowLeft", shift=True)
    assert at() == decided[1]
    browser.press("PageDown")
    assert run.frames[at()].trial == 1 and run.frames[at() - 1].trial == 0
    browser.press("End")
    assert at() == len(run.frames) - 1
    assert "trial 3 of 3" in browser.text("where") and "discovered" in browser.text("where")
    browser.press("Home")
    browser.press("+")
    assert browser.value("state.speed") == 2
    browser.press(" ")
    assert browser.text("play") == "Pause"
    wait(lambda: at() > 20, "a later frame")
    browser.press(" ")
    stopped = at()
    time.sleep(0.3)
    assert at() == stopped and browser.text("play") == "Play"


def test_dark(browser, html, tmp_path):
    browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    try:
        browser.open(html)
        assert pixels_of(browser, tmp_path, "#1e2125") > 100_000
    finally:
        browser.ask("Emulation.setEmulatedMedia", features=[])


def test_truth_on_request(browser, log, tmp_path):
    if not grrl.HAS_WORLD:
        pytest.skip("needs Box2D")
    out = tmp_path / "out.html"
    assert command.main([str(log), "--truth", OBJECT, "--seed", str(SEED), "--html", str(out)]) == 0
    browser.open(out.as_uri())
    assert "truth of the simulator: RPR, seed 3" in browser.text("truth-mark")
    assert "truth of the simulator" in browser.text("legend")
    assert pixels_of(browser, tmp_path, "#c2188b") > 60
    browser.press("t")
    assert pixels_of(browser, tmp_path, "#c2188b") == 0
    assert browser.value("document.getElementById('truth-mark').hidden")


def test_log_through_the_server(browser, log):
    log = pathlib.Path(os.environ.get("GRRL_VIEW_LOG", log))  # one of your own, to measure
    viewer = Viewer(log)
    try:
        browser.open(viewer.url)
        print(f"a log of {log.stat().st_size} bytes: {time.monotonic() - viewer.began:.2f} s from the "
              "command to the picture")
        run = read_log(log)
        assert int(browser.value("document.body.dataset.frames")) == len(run.frames)
        assert_shows(browser, run, int(browser.value("document.body.dataset.at")))
        assert browser.errors == []

        async def strangers():
            async with aiohttp.ClientSession() as session:
                for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
                    async with session.get(viewer.url + "data", headers=headers) as answer:
                        assert answer.status == 403, headers

        asyncio.run(strangers())
    finally:
        assert viewer.stop() == 0


def test_port_that_is_taken(log):
    viewer = Viewer(log)
    try:
        port = viewer.url.rstrip("/").rsplit(":", 1)[1]
        done = subprocess.run([sys.executable, "-m", "grrl.view", "--no-browser", "--port", port, log],
                              capture_output=True, text=True, timeout=_WAIT_S, check=False)
        assert done.returncode == 1 and port in done.stderr and "Traceback" not in done.stderr
    finally:
        assert viewer.stop() == 0


# --- live


def test_log_that_is_being_written(browser, log, tmp_path):
    path = tmp_path / "growing.lcm"
    viewer = Viewer("--live", path)
    try:
        browser.open(viewer.url)
        wait(lambda: "nothing heard on" in browser.text("notice"), "the notice")
        data = log.read_bytes()
        with open(path, "wb", buffering=0) as file:
            at = 0
            while at < len(data):
                file.write(data[at:at + 50_000])
                at += 50_000
                time.sleep(0.02)
        run = read_log(log)
        wait(lambda: "trial 3" in browser.text("where") and browser.text("term") == run.models[-1].term,
             "the last model")
        last = max(i for i, f in enumerate(run.frames) if f.push >= 0)
        assert_shows(browser, run, last)
        assert browser.text("live") == "live"
        assert browser.value("state.run.trials.map((t) => t.pushes)") == [t.pushes for t in run.trials]
        assert browser.value("state.run.pushes.map((p) => p.why)") == [p.why for p in run.pushes]
        browser.press("Home")
        assert browser.text("live") == "paused" and browser.value("state.at") == 0
        browser.press("l")
        assert browser.text("live") == "live"
        assert browser.errors == []
    finally:
        assert viewer.stop() == 0
    wait(lambda: "grrl-view has ended" in browser.text("notice"), "the notice")


def test_live_run_goes_on_for_a_browser_that_comes_late(browser, log, tmp_path):
    path = tmp_path / "run.lcm"
    shutil.copy(log, path)
    viewer = Viewer("--live", path)
    try:
        run = read_log(log)
        for _ in range(2):
            browser.open(viewer.url)
            wait(lambda: browser.text("term") == run.models[-1].term and "trial 3" in browser.text("where"),
                 "the last model")
    finally:
        assert viewer.stop() == 0


def test_on_the_bus():
    """The functions bus_*, in a network where LCM works."""
    pytest.importorskip("lcm")
    done = subprocess.run([ROOT / "tools" / "network", sys.executable, "-m", "pytest", "-p",
                           "no:cacheprovider", "-s", "-o", "python_functions=bus_*", __file__],
                          capture_output=True, text=True, timeout=600, check=False, cwd=ROOT / "python")
    print(done.stdout)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


URL = "udpm://239.255.76.67:7922?ttl=0"


def bus_shows_a_run(browser, tmp_path):
    viewer = Viewer("--live", "--lcm-url", URL)
    try:
        browser.open(viewer.url)
        wait(lambda: f"nothing heard on {URL} yet" in browser.text("notice"), "the notice")
        agent = subprocess.Popen([program("AGENT"), "--lcm-url", URL, "--quiet"])
        sim = subprocess.run([program("SIM"), "--lcm-url", URL, "--object", OBJECT, "--trials", "2",
                              "--log", tmp_path / "run.lcm", "--quiet", "--agent-timeout", "60"],
                             timeout=_WAIT_S, check=True)
        assert sim.returncode == agent.wait(_WAIT_S) == 0
        run = read_log(tmp_path / "run.lcm")
        wait(lambda: browser.text("term") == run.models[-1].term and "trial 2" in browser.text("where"),
             "the last model")
        assert_shows(browser, run, max(i for i, f in enumerate(run.frames) if f.push >= 0))
        link = run.models[-1].links[0]
        assert pixels_of(browser, tmp_path, colour_of(link.n - 1)) > 60
        wait(lambda: "nothing heard for" in browser.text("notice"), "the notice")
    finally:
        assert viewer.stop() == 0


def bus_delay(browser):
    """How long a frame at 30 Hz takes from the bus to the canvas; printed, for a busy machine is slow."""
    import lcm

    viewer = Viewer("--live", "--lcm-url", URL)
    try:
        browser.open(viewer.url)
        browser.value("window.drawn = []; window.draw = show; show = () => { draw(); const last = "
                      "state.run.frames[state.at]; if (last) drawn.push([Math.round(last.x[0] * "
                      "state.run.length_m * 1000), Date.now()]); }; 0")
        bus, sent = lcm.LCM(URL), {}
        for seq in range(1, 151):  # a point is at seq millimetres; the last frame is always kept
            sent[seq] = time.time()
            bus.publish("GRRL_POINTS", points(seq, SQUARE + 0.001 * seq, utime=seq * 33_333,
                                              phase=3 if seq == 150 else 1))
            time.sleep(1 / 30)
        drawn = wait(lambda: browser.value("drawn.length && drawn.at(-1)[0] === 150 && drawn"),
                     "the last frame")
        delays = sorted(min(t for n, t in drawn if n >= seq) / 1000 - at for seq, at in sent.items())
        print(f"delay from the bus to the canvas: median {delays[75]:.3f} s, longest {delays[-1]:.3f} s")
    finally:
        assert viewer.stop() == 0
