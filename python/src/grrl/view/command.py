"""The command grrl-view."""

from __future__ import annotations

import argparse
import asyncio
import os
import pathlib
import signal
import sys
import webbrowser
from typing import Any

from .. import _native
from . import pack
from .run import MAX_FRAMES, Run, read_log

_DESCRIPTION = """\
Shows a run: the points coloured by the link they are believed to belong to, pivots and axes with
their probability, the next push and why, the term, and the pushes that each trial took. In a
browser, without internet."""
_EPILOG = """\
LOG is what grrl-sim --log or lcm-logger writes. With --live it may still be growing, or not be
there yet; without LOG --live follows the bus. Without --lcm-url the environment variable
LCM_DEFAULT_URL counts.
Exit status: 0 fine, also after Ctrl-C; 1 trouble; 2 wrong command line."""
_LIVE_GAP_US = 5000  # between frames that are kept of a live run: a world may run faster than time


def _number(low: float, high: float, kind: type) -> Any:
    def parse(text: str) -> Any:
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not low <= value <= high:
            what = "a whole number" if kind is int else "a number"
            raise argparse.ArgumentTypeError(f"{text}: must be {what} from {low:g} to {high:g}")
        return value

    return parse


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="grrl-view", allow_abbrev=False, description=_DESCRIPTION, epilog=_EPILOG, add_help=False,
        usage="grrl-view [OPTION]... LOG | --live",
        formatter_class=lambda prog: argparse.RawDescriptionHelpFormatter(prog, max_help_position=21))
    add = parser.add_argument
    add("log", nargs="?", metavar="LOG", help="an LCM log")
    add("--live", action="store_true", help="follow the bus, or a LOG that is being written")
    add("--lcm-url", metavar="URL", help="LCM provider, for --live")
    add("--html", metavar="FILE", type=pathlib.Path,
        help="write one HTML file that holds the run, and show nothing")
    add("--mp4", metavar="FILE", type=pathlib.Path,
        help="write a film (needs matplotlib and ffmpeg), and show nothing")
    add("--trial", metavar="N", type=_number(0, 2**31 - 1, int), help="this trial of LOG only")
    add("--speed", metavar="X", type=_number(0.1, 100, float), help="the film X times as fast (1)")
    add("--truth", metavar="OBJECT",
        help="lay over what grrl-sim knew: the same world, simulated again from the --object of its "
             "run and the pushes in LOG")
    add("--seed", metavar="N", type=_number(0, 2**64 - 1, int),
        help="the --seed of that run of grrl-sim (1)")
    add("--port", metavar="N", type=_number(0, 65535, int), help="of the page on 127.0.0.1 (a free one)")
    add("--no-browser", action="store_true", help="print the address and open no browser")
    add("--help", action="help", help="print this help")
    add("--version", action="version", version=f"grrl-view {_native.VERSION}", help="print the version")
    return parser


def _refuse(parser: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    """Ends with status 2 if options contradict each other."""
    writes = options.html is not None or options.mp4 is not None
    if options.log is None and not options.live:
        parser.error("a LOG is missing, or --live")
    if options.live:
        for name in ("html", "mp4", "truth", "trial"):
            if getattr(options, name) is not None:
                parser.error(f"--{name} needs a complete LOG, without --live")
    if options.log is not None and options.lcm_url is not None:
        parser.error("--lcm-url and LOG contradict each other")
    if options.lcm_url is not None and not options.live:
        parser.error("--lcm-url needs --live")
    if options.seed is not None and options.truth is None:
        parser.error("--seed needs --truth")
    if options.speed is not None and options.mp4 is None:
        parser.error("--speed needs --mp4")
    if writes and (options.port is not None or options.no_browser):
        parser.error("--port and --no-browser need a page that is shown, without --html and --mp4")


def _note(text: str) -> None:
    print(f"grrl-view: {text}", file=sys.stderr, flush=True)


def _aiohttp() -> Any:
    try:
        from . import server
    except ImportError:
        raise ImportError("showing a page needs the package aiohttp: pip install 'grrl[view]'; "
                          "--html FILE does without") from None
    return server


def _serve(app: Any, options: argparse.Namespace) -> None:
    server = _aiohttp()

    def ready(url: str) -> None:
        print(f"{url} (Ctrl-C ends)", flush=True)
        screen = sys.platform in ("darwin", "win32") or any(
            os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))
        if not options.no_browser and not (screen and webbrowser.open(url)):
            _note("no browser to open; open the address above in one")

    async def until_stopped() -> None:
        loop = asyncio.get_running_loop()
        task = asyncio.current_task()
        assert task is not None
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, task.cancel)
        try:
            await server.serve(app, options.port or 0, ready)
        except asyncio.CancelledError:
            pass

    asyncio.run(until_stopped())


def _show_live(options: argparse.Namespace) -> None:
    from .live import Bus, GrowingLog

    server = _aiohttp()
    source = GrowingLog(options.log) if options.log is not None else Bus(options.lcm_url)
    run = Run(least_gap_us=_LIVE_GAP_US, max_frames=MAX_FRAMES)
    _note(f"following {source.title}")
    _serve(server.live_app(run, source), options)


def _replace(path: pathlib.Path, text: str) -> None:
    new = path.with_name(path.name + ".new")
    new.write_text(text, encoding="utf-8")
    new.replace(path)


def _show_log(options: argparse.Namespace) -> None:
    run = read_log(options.log)
    for line in run.warnings():
        _note(f"{options.log}: {line}")
    truth = None
    if options.trial is not None:
        run = run.only(options.trial)
    if options.truth is not None:
        from .truth import truth_of

        truth = truth_of(run, options.truth, 1 if options.seed is None else options.seed)
    title = pathlib.Path(options.log).name
    if options.mp4 is not None:
        from .movie import write_film

        write_film(run, options.mp4, title, 1.0 if options.speed is None else options.speed, truth)
        print(options.mp4)
    if options.html is not None:
        _replace(options.html, pack.page(pack.pack(run, title, truth=truth), title))
        print(options.html)
    if options.mp4 is None and options.html is None:
        _serve(_aiohttp().log_app(pack.pack(run, title, truth=truth), title), options)


def main(arguments: list[str] | None = None) -> int:
    parser = _parser()
    options = parser.parse_args(arguments)
    _refuse(parser, options)
    try:
        if options.live:
            _show_live(options)
        else:
            _show_log(options)
    except KeyboardInterrupt:
        return 0
    except (ImportError, OSError, RuntimeError, ValueError) as error:
        _note(str(error))
        return 1
    return 0
