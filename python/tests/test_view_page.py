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
import struct
import subprocess
import sys
import time

import pytest
from conftest import ROOT, program

aiohttp = pytest.importorskip("aiohttp", reason="needs the package aiohttp")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
if CHROMIUM is None:
    pytest.skip("needs Chromium: tools/setup python", allow_module_level=True)
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
