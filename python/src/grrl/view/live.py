"""What follows the bus, or a log that is being written, in a thread of its own."""

from __future__ import annotations

import os
import queue
import struct
import threading
import time

from ..io import _EVENT, _SYNC, _events
from . import wire

Heard = tuple[str, bytes, int]  # channel, message, time (us)
_POLL_S = 0.03
_WAIT_MS = 200


class Source(threading.Thread):
    """Puts what it hears into `heard` until `end` is called; `over` says why it ended by itself."""

    def __init__(self, name: str) -> None:
        super().__init__(name="grrl-view", daemon=True)
        self.title = name
        self.heard: queue.SimpleQueue[Heard] = queue.SimpleQueue()
        self.over = ""
        self._end = threading.Event()

    def end(self) -> None:
        self._end.set()
        self.join(2)


class Bus(Source):
    """LCM.

    Raises
    ------
    ImportError
        The package lcm is missing.
    RuntimeError
        There is no such bus.
    """

    def __init__(self, url: str | None) -> None:
        try:
            import lcm
        except ImportError:
            raise ImportError("--live needs the package lcm: pip install 'grrl[view]'") from None
        super().__init__(url or os.environ.get("LCM_DEFAULT_URL") or "udpm://239.255.76.67:7667?ttl=0")
        try:
            self._lcm = lcm.LCM(url or "")
        except RuntimeError:
            raise RuntimeError(f"no LCM at {self.title}: multicast needs a route, such as ip route add "
                               "224.0.0.0/4 dev lo (docs/messages.md); a log that is being written can "
                               "be followed without: --live run.lcm") from None
        channels = "|".join(wire.CHANNELS)
        self._lcm.subscribe(f"^({channels})$", self._take).set_queue_capacity(0)

    def _take(self, channel: str, data: bytes) -> None:
        self.heard.put((channel, data, time.monotonic_ns() // 1000))

    def run(self) -> None:
        while not self._end.is_set():
            try:
                self._lcm.handle_timeout(_WAIT_MS)
            except OSError as error:
                self.over = f"{self.title}: {error}" if str(error) else f"{self.title} has ended"
                return


def whole_events(data: bytes) -> int:
    """How many bytes of a log that grows are events to their end; what is damaged counts as whole
    up to the next event."""
    at = 0
    while len(data) - at >= _EVENT.size:
        sync, _, _, n_channel, n_data = _EVENT.unpack_from(data, at)
        end = at + _EVENT.size + n_channel + n_data
        if sync != _SYNC or not 0 < n_channel < 1000 or n_data > 1 << 24:
            end = data.find(_SYNC, at + 1)
            if end < 0:
                return at
        if end > len(data):
            return at
        at = end
    return at


class GrowingLog(Source):
    """A log that grrl-sim --log or lcm-logger is writing; it may begin later."""

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self._path = path
        if os.path.isdir(path):
            raise IsADirectoryError(f"{path} is a folder")

    def run(self) -> None:
        rest = b""
        while not os.path.exists(self._path):
            if self._end.wait(_POLL_S):
                return
        try:
            with open(self._path, "rb") as file:
                while not self._end.is_set():
                    rest += file.read(1 << 20)
                    n = whole_events(rest)
                    for event in _events(rest[:n]):
                        if event is not None:
                            self.heard.put((event[0].decode("utf-8", "replace"), event[1], event[2]))
                    rest = rest[n:]
                    if n == 0:
                        self._end.wait(_POLL_S)
        except (OSError, struct.error) as error:
            self.over = f"{self._path}: {error}"
