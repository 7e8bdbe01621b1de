"""The page on this machine: a run from a log, or one that is followed."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator
from typing import Any

from aiohttp import WSMsgType, web

from . import pack
from .live import Source
from .run import Run

_TICK_S = 0.04
_INFO_S = 1.0
_MAX_WAITING = 200  # messages; a browser that is slower starts anew
_HERE = ("127.0.0.1", "localhost", "[::1]")
_POLICY = ("default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
           "img-src data:; connect-src 'self'")


class Follower:
    """Takes what a source hears into a run, and tells the browsers."""

    def __init__(self, run: Run, source: Source) -> None:
        self.run, self.source = run, source
        self.browsers: set[asyncio.Queue[bytes | str]] = set()
        self._sent = (0, 0, 0)
        self._last = time.monotonic()
        self._told = 0.0

    def info(self) -> dict[str, Any]:
        """What is said about the bus."""
        run = self.run
        status = {name: run.status[name] for name in ("entries", "capacity", "lost", "rejected", "foreign")
                  if run.status}
        return {"warnings": run.warnings(), "stopped": run.stopped, "over": self.source.over,
                "silent_s": round(time.monotonic() - self._last, 1), "heard": run.heard.total(),
                "channels": sorted(run.heard), "status": status}

    def whole(self) -> bytes:
        return pack.pack(self.run, self.source.title, live=True, info=self.info())

    def take(self) -> bool:
        """Everything heard until now; whether it changed anything."""
        changed = False
        while not self.source.heard.empty():
            channel, data, time_us = self.source.heard.get()
            changed |= self.run.add(channel, data, time_us)
            self._last = time.monotonic()
        return changed

    def news(self) -> str:
        """What browsers do not have yet. The last of what they have may have changed since."""
        run = self.run
        frames, models, pushes = self._sent
        changes: dict[str, Any] = {
            "frames": [pack.frame_json(f) for f in run.frames[frames:]], "first": frames,
            "models": [[i, pack.model_json(m)] for i, m in enumerate(run.models[models:], models)],
            "pushes": [[i, pack.record_json(run.pushes[i])]
                       for i in range(max(0, pushes - 2), len(run.pushes))],
            "trials": [[i, pack.record_json(run.trials[i])]
                       for i in range(max(0, len(run.trials) - 20), len(run.trials))],
            "info": self.info()}
        if 0 < frames <= len(run.frames):
            last = pack.frame_json(run.frames[frames - 1])
            changes["last"] = {k: last[k] for k in ("model", "push", "stage", "motion")}
        self.sent()
        return json.dumps(changes, separators=(",", ":"))

    def sent(self) -> None:
        self._sent = (len(self.run.frames), len(self.run.models), len(self.run.pushes))

    def tell(self, message: bytes | str) -> None:
        for waiting in list(self.browsers):
            if waiting.qsize() > _MAX_WAITING:
                self.browsers.discard(waiting)
                while not waiting.empty():
                    waiting.get_nowait()
                waiting.put_nowait("")
            else:
                waiting.put_nowait(message)

    def tick(self) -> None:
        dropped = self.run.dropped
        if self.take():
            if self.run.dropped != dropped:
                self.sent()
                self.tell(self.whole())
            elif self.browsers:
                self.tell(self.news())
            else:
                self.sent()
        elif self.browsers and time.monotonic() - self._told > _INFO_S:
            self._told = time.monotonic()
            self.tell(json.dumps({"info": self.info()}))

    async def follow(self) -> None:
        while True:
            self.tick()
            await asyncio.sleep(_TICK_S)


@web.middleware
async def _only_from_here(request: web.Request, handler: Any) -> web.StreamResponse:
    """No other site may read a run through the browser: its requests have another host or origin."""
    host = request.host.rsplit(":", 1)[0] if not request.host.endswith("]") else request.host
    origin = request.headers.get("Origin")
    if host not in _HERE or (origin is not None and origin != f"http://{request.host}"):
        raise web.HTTPForbidden(text="grrl-view answers this machine only")
    return await handler(request)


def _page(title: str) -> Any:
    async def answer(_: web.Request) -> web.Response:
        return web.Response(text=pack.page(title=title), content_type="text/html",
                            headers={"Content-Security-Policy": _POLICY, "Cache-Control": "no-store"})

    return answer


def _live(follower: Follower) -> Any:
    async def answer(request: web.Request) -> web.WebSocketResponse:
        socket = web.WebSocketResponse(heartbeat=20, max_msg_size=1 << 16)
        await socket.prepare(request)
        waiting: asyncio.Queue[bytes | str] = asyncio.Queue()
        follower.tick()
        waiting.put_nowait(follower.whole())
        follower.browsers.add(waiting)
        sender = asyncio.create_task(_send(socket, waiting))
        try:
            async for message in socket:
                if message.type == WSMsgType.ERROR:
                    break
        finally:
            follower.browsers.discard(waiting)
            sender.cancel()
        return socket

    return answer


async def _send(socket: web.WebSocketResponse, waiting: asyncio.Queue[bytes | str]) -> None:
    while True:
        message = await waiting.get()
        if message == "":
            await socket.close()
            return
        with contextlib.suppress(ConnectionError):
            await (socket.send_bytes(message) if isinstance(message, bytes)
                   else socket.send_str(message))


def log_app(data: bytes, title: str) -> web.Application:
    """The page with a run that is complete."""
    app = web.Application(middlewares=[_only_from_here])

    async def answer(_: web.Request) -> web.Response:
        return web.Response(body=data, content_type="application/octet-stream")

    app.router.add_get("/", _page(title))
    app.router.add_get("/data", answer)
    return app


def live_app(run: Run, source: Source) -> web.Application:
    """The page with a run that is followed."""
    app = web.Application(middlewares=[_only_from_here])
    follower = Follower(run, source)

    async def answer(_: web.Request) -> web.Response:
        return web.Response(body=follower.whole(), content_type="application/octet-stream")

    async def background(_: web.Application) -> AsyncIterator[None]:
        source.start()
        task = asyncio.create_task(follower.follow())
        yield
        task.cancel()
        await asyncio.to_thread(source.end)

    app.cleanup_ctx.append(background)
    app.router.add_get("/", _page(source.title))
    app.router.add_get("/data", answer)
    app.router.add_get("/live", _live(follower))
    return app


async def serve(app: web.Application, port: int, ready: Any) -> None:
    """Until it is cancelled; ready(url) is called once it answers."""
    runner = web.AppRunner(app, access_log=None, shutdown_timeout=0.5)
    await runner.setup()
    try:
        site = web.TCPSite(runner, "127.0.0.1", port)
        await site.start()
        ready(f"http://127.0.0.1:{runner.addresses[0][1]}/")
        await asyncio.Event().wait()
    finally:
        await runner.cleanup()
