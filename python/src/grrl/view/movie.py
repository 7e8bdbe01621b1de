"""A run as a film, for a lecture: matplotlib draws, ffmpeg codes."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile
import textwrap
from bisect import bisect_right
from typing import Any

import numpy as np

from ..plot import _INK, colour_of
from .run import COMING, OVER, UNDER_WAY, Frame, ModelSeen, Run

_RATE = 30
_PLACE = (0.055, 0.075, 0.60, 0.855)  # of the table in the picture
_SIZE_PX = (1280, 720)
_DPI = 100
_STILL, _SOFT, _ACCENT, _PUSH, _TRUTH = "#b5b5b5", "#6b6b6b", "#1666a8", "#c1121f", "#c2188b"
_TITLES = ("No push yet", "Next push", "Push under way", "Last push")


def _ffmpeg() -> str:
    """The program, of Debian or of the package imageio-ffmpeg."""
    found = shutil.which("ffmpeg")
    if found is None:
        try:
            import imageio_ffmpeg

            found = imageio_ffmpeg.get_ffmpeg_exe()
        except (ImportError, RuntimeError):
            raise ImportError("--mp4 needs ffmpeg: apt-get install ffmpeg, or pip install "
                              "imageio-ffmpeg") from None
    return found


def moved(frame: Frame, link: int, x: float, y: float) -> tuple[float, float, float]:
    """Where a point of a link of the model is in a frame, and how far the link has turned (rad)."""
    tx, ty, angle = frame.motion[link]
    c, s = np.cos(angle), np.sin(angle)
    return float(c * x - s * y + tx), float(s * x + c * y + ty), float(angle)


def view_of(run: Run, trial: int) -> tuple[float, float, float, float]:
    """x0, x1, y0, y1 (m) of what is shown of a trial: the object with some room, else all points."""
    parts = [[], []]  # type: list[list[np.ndarray]]
    for frame in [f for f in run.frames if f.trial == trial][::5]:
        parts[1].append(frame.xy)
        if frame.model >= 0 and frame.ids.size:
            model = run.models[frame.model]
            place = np.minimum(np.searchsorted(model.ids, frame.ids), model.ids.size - 1)
            known = (model.ids[place] == frame.ids) & (model.link_of[place] >= 0)
            parts[0].append(frame.xy[known])
    found = [np.concatenate(part) for part in parts if part]
    points = next((xy for xy in found if len(xy)), np.array([[-1.0, -0.8], [1.0, 0.8]]))
    low, high = np.percentile(points, [0.2, 99.8], axis=0)
    room = max(0.12, 0.05 * float((high - low).max()))
    middle, half = (low + high) / 2, (high - low) / 2 + room
    shape = _PLACE[2] * _SIZE_PX[0] / (_PLACE[3] * _SIZE_PX[1])  # a metre is as long both ways
    half = np.maximum(half, (half[1] * shape, half[0] / shape))
    return middle[0] - half[0], middle[0] + half[0], middle[1] - half[1], middle[1] + half[1]


class Film:
    """Draws frames of a run on one figure."""

    def __init__(self, run: Run, title: str, truth: Any = None) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.run, self.title, self.truth = run, title, truth
        self.figure = Figure(figsize=(_SIZE_PX[0] / _DPI, _SIZE_PX[1] / _DPI), dpi=_DPI)
        self.canvas = FigureCanvasAgg(self.figure)
        self.table = self.figure.add_axes(_PLACE)
        self.curve = self.figure.add_axes((0.715, 0.075, 0.265, 0.20))
        self._views: dict[int, tuple[float, float, float, float]] = {}
        self._curve_of = -2
        self._words: list[Any] = []

    def draw(self, number: int) -> memoryview:
        """The picture of a frame, rows of RGBA."""
        run, ax, frame = self.run, self.table, self.run.frames[number]
        ax.clear()
        if frame.trial not in self._views:
            self._views[frame.trial] = view_of(run, frame.trial)
        x0, x1, y0, y1 = self._views[frame.trial]
        ax.set(xlim=(x0, x1), ylim=(y0, y1), xlabel="x (m)", ylabel="y (m)")
        ax.grid(color="#e4e4e4", linewidth=0.7)
        ax.set_axisbelow(True)
        model = run.models[frame.model] if frame.model >= 0 else None
        self._points(frame, model)
        if self.truth is not None:
            self._truth(number)
        self._push(frame)
        if model is not None:
            self._joints(frame, model)
        self._texts(frame, model)
        self._pushes_a_trial(frame.trial)
        self.canvas.draw()
        return self.canvas.buffer_rgba()

    def _points(self, frame: Frame, model: ModelSeen | None) -> None:
        link = np.full(frame.ids.size, -2)
        if model is not None and model.ids.size:
            place = np.minimum(np.searchsorted(model.ids, frame.ids), model.ids.size - 1)
            link = np.where(model.ids[place] == frame.ids, model.link_of[place], -2)
        ax = self.table
        ax.plot(*frame.xy[link == -1].T, "o", color=_STILL, markersize=3)
        ax.plot(*frame.xy[link == -2].T, "o", color="none", markeredgecolor=_STILL, markersize=4)
        for i, body in enumerate(model.links if model is not None else ()):
            assert model is not None
            colour = colour_of(body.n - 1)
            x, y, turn = moved(frame, i, body.x, body.y)
            self._box(x, y, body.angle + turn, body.length + 0.02, body.width + 0.02,
                      facecolor=colour + "22", edgecolor=colour + "77")
            ax.plot(*frame.xy[link == i].T, "o", color=colour, markersize=4.5)
            side, away = body.angle + turn + np.pi / 2, body.width / 2 + 0.03
            ax.text(x + away * np.cos(side), y + away * np.sin(side), f"f{body.n}", color=colour,
                    weight="bold", ha="center", va="center", clip_on=True)

    def _box(self, x: float, y: float, angle: float, length: float, width: float, **style: Any) -> None:
        from matplotlib.patches import Rectangle

        self.table.add_patch(Rectangle((x - length / 2, y - width / 2), length, width,
                                       angle=np.degrees(angle), rotation_point="center", **style))

    def _truth(self, number: int) -> None:
        for (length, width), (x, y, angle) in zip(self.truth.sizes, self.truth.poses[number]):
            self._box(x, y, angle, length, width, fill=False, edgecolor=_TRUTH, linestyle="--")

    def _push(self, frame: Frame) -> None:
        push = self.run.pushes[frame.push] if frame.push >= 0 else None
        if push is None or push.start is None or push.end is None:
            return
        style = {"color": _PUSH, "alpha": 0.25 if frame.stage == OVER else 1.0}
        self.table.annotate("", push.end, push.start, arrowprops={
            **style, "arrowstyle": "-|>", "linewidth": 3 if frame.stage == UNDER_WAY else 2,
            "linestyle": "--" if frame.stage == COMING else "-", "shrinkA": 0, "shrinkB": 0})
        self.table.plot(*push.start, "o", markerfacecolor="none", markersize=9, **style)

    def _joints(self, frame: Frame, model: ModelSeen) -> None:
        for joint in model.joints:
            x, y, turn = moved(frame, joint.a, joint.x, joint.y)
            style = {"color": _INK, "alpha": 0.35 + 0.65 * joint.p}
            if joint.type == "revolute":
                self.table.plot(x, y, "o", markerfacecolor="white", markersize=9, **style)
                self.table.plot(x, y, "+", markersize=15, markeredgewidth=2, **style)
            else:
                reach = 0.6 * (model.links[joint.a].length + model.links[joint.b].length)
                dx = reach * np.cos(joint.angle + turn)
                dy = reach * np.sin(joint.angle + turn)
                self.table.plot([x - dx, x + dx], [y - dy, y + dy], "--", linewidth=2, **style)
            side = model.links[joint.a].angle + turn - np.pi / 2
            self.table.annotate(f"{joint.p:.2f}", (x, y), (24 * np.cos(side), 24 * np.sin(side)),
                                textcoords="offset points", fontsize=9, ha="center", va="center")

    def _texts(self, frame: Frame, model: ModelSeen | None) -> None:
        for word in self._words:
            word.remove()
        self._words = []
        y = 0.955

        def say(text: str, step: float, **style: Any) -> None:
            nonlocal y
            for line in text.split("\n"):
                self._words.append(self.figure.text(0.68, y, line, va="top", **style))
                y -= step
        trial = self.run.trials[frame.trial]
        head = f"trial {trial.id}" if trial.id else "no supervisor"
        self._words.append(self.figure.text(0.055, 0.96, f"{self.title}, {head}", weight="bold"))
        if self.truth is not None:
            self._words.append(self.figure.text(
                0.655, 0.96, f"with the truth of the simulator: {self.truth.object}", color=_TRUTH,
                ha="right"))
        push = self.run.pushes[frame.push] if frame.push >= 0 else None
        say(_TITLES[frame.stage] if push else _TITLES[0], 0.04, color=_SOFT)
        colour = next((colour_of(i.n - 1) for i in (model.links if model else ())
                       if push and i.n == push.link), _INK)
        say(f"f{push.link} at {push.direction}\u00b0" if push and push.link else "", 0.055, fontsize=17,
            weight="bold", color=colour)
        say("\n".join(textwrap.wrap(push.why, 46)) if push else "", 0.035)
        y = min(y, 0.76)
        say("Structure believed", 0.04, color=_SOFT)
        say("\n".join(textwrap.wrap(model.term, 46)) if model else "nothing yet", 0.032, fontsize=9,
            family="monospace")
        y -= 0.015
        say("Joints", 0.04, color=_SOFT)
        for joint in (model.joints if model else ())[:9]:
            assert model is not None
            names = f"f{model.links[joint.a].n} f{model.links[joint.b].n}"
            say(f"{names:<8} {joint.type:<10} {joint.p:.3f}", 0.032, fontsize=9, family="monospace")

    def _pushes_a_trial(self, current: int) -> None:
        if current == self._curve_of:
            return
        self._curve_of = current
        ax = self.curve
        ax.clear()
        trials = [(i, t) for i, t in enumerate(self.run.trials) if t.id > 0 and t.outcome != "aborted"]
        ax.set_title("Pushes a trial (line: mean of five)", fontsize=9, color=_SOFT, loc="left")
        ax.set_xlabel("trial", fontsize=9)
        ax.tick_params(labelsize=8)
        ax.grid(axis="y", color="#e4e4e4")
        if not trials:
            return
        pushes = np.array([t.pushes for _, t in trials])
        ids = np.array([t.id for _, t in trials])
        ax.plot(ids, pushes, ".", color=_ACCENT)
        if len(trials) > 4:
            ax.plot(ids[4:], np.convolve(pushes, np.ones(5) / 5, "valid"), color=_ACCENT)
        for i, trial in trials:
            if i == current:
                ax.plot(trial.id, trial.pushes, "o", color=_INK)
        ax.set_ylim(bottom=0)


def write_film(run: Run, path: pathlib.Path, title: str, speed: float = 1.0, truth: Any = None) -> int:
    """Writes an MP4 (H.264), 1280 x 720 at 30 pictures a second; returns how many pictures.

    Raises
    ------
    ImportError
        matplotlib or ffmpeg is missing.
    RuntimeError
        ffmpeg failed, and what it said.
    """
    try:
        film = Film(run, title, truth)
    except ImportError:
        raise ImportError("--mp4 needs matplotlib: pip install 'grrl[plot]'") from None
    program = _ffmpeg()
    times = [frame.t for frame in run.frames]
    shown = np.arange(times[0], times[-1] + 1.0, speed / _RATE)
    new = path.with_name(path.name + ".new")
    command = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pixel_format", "rgba",
               "-video_size", f"{_SIZE_PX[0]}x{_SIZE_PX[1]}", "-framerate", str(_RATE), "-i", "-",
               "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", os.fspath(new)]
    with tempfile.TemporaryFile() as said:
        coder = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=said)
        assert coder.stdin is not None
        try:
            last, picture = -1, memoryview(b"")
            for t in shown:
                number = bisect_right(times, t) - 1
                if number != last:
                    picture, last = film.draw(number), number
                coder.stdin.write(picture)
            coder.stdin.close()
        except BrokenPipeError:
            pass
        except BaseException:
            coder.kill()
            coder.wait()
            new.unlink(missing_ok=True)
            raise
        if coder.wait() != 0:
            said.seek(0)
            raise RuntimeError(f"ffmpeg: {said.read().decode(errors='replace').strip()}")
    new.replace(path)
    return len(shown)
