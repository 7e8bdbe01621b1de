#!/usr/bin/env python3
"""A tracker and a robot in front of a hinge, to begin your own from. docs/robot.md goes through it.

    export PYTHONPATH=build/release/lcmtypes/python
    python3 examples/robot.py &
    grrl-agent --explain --until-sure 0.95 --pushes 40

The class Robot is all that speaks to grrl-agent; keep it. The class Hinge is what you replace: a
camera that finds points, and an arm. Ctrl-C is the red button.
"""

import math
import random
import select
import signal
import sys
import time

import lcm
from grrl_lcmtypes import points_t, push_command_t, push_status_t, stop_t

FRAMES_PER_S = 50
WORKSPACE_M = (-0.5, -0.4, 0.5, 0.4)  # x0, y0, x1, y1: what the arm reaches and nobody stands in
MAX_FORCE_N, MAX_SPEED_M_S = 10.0, 0.1


class Robot:
    """Tracker and robot on LCM, without a supervisor."""

    def __init__(self, bus, plant):
        self.bus, self.plant = bus, plant
        self.session = random.randrange(1, 2**62)
        self.seq = 0
        self.obeyed = {}  # the last cmd_seq, by agent
        self.command = None  # the push under way
        bus.subscribe("GRRL_PUSH_COMMAND", self.on_command).set_queue_capacity(0)

    def on_command(self, channel, data):
        command = push_command_t.decode(data)
        if command.kind != command.PUSH or command.plant_session_id != self.session:
            return
        if command.cmd_seq <= self.obeyed.get(command.session_id, 0):
            return  # sent again, until it is acknowledged; it acts once
        self.obeyed[command.session_id] = command.cmd_seq
        if self.may(command):
            self.command = command
            self.plant.begin(command)
            self.report(command, push_status_t.MOVING, push_status_t.NONE)
        else:
            self.report(command, push_status_t.REFUSED, push_status_t.BAD_COMMAND)

    def may(self, command):
        x0, y0, x1, y1 = WORKSPACE_M
        return (command.force <= MAX_FORCE_N and command.speed <= MAX_SPEED_M_S and all(
            x0 <= x <= x1 and y0 <= y <= y1 for x, y in (command.start, command.end)))

    def report(self, command, state, reason):
        status = push_status_t()
        status.utime, status.session_id = int(time.time() * 1e6), self.session
        status.agent_session_id = command.session_id  # these three say which push this is about
        status.trial_id, status.cmd_seq = command.trial_id, command.cmd_seq
        status.state, status.reason = state, reason
        self.bus.publish("GRRL_PUSH_STATUS", status.encode())

    def frame(self):
        """One picture of the camera."""
        if self.command:
            reason = self.plant.step(1.0 / FRAMES_PER_S)
            if reason is not None:  # the tool is lifted, and the object lies still
                self.report(self.command, push_status_t.DONE, reason)
                self.command = None
        self.seq += 1
        points = points_t()
        points.utime, points.session_id, points.seq = int(time.time() * 1e6), self.session, self.seq
        points.mode, points.phase = points.REAL_TIME, points.UNKNOWN  # the agent goes by the status
        points.id, points.x, points.y = self.plant.see()
        points.n_points = len(points.id)
        self.bus.publish("GRRL_POINTS", points.encode())

    def stop(self, reason):
        stop = stop_t()
        stop.utime, stop.session_id = int(time.time() * 1e6), self.session
        stop.reason = reason
        for _ in range(3):  # one may get lost
            self.bus.publish("GRRL_STOP", stop.encode())
            time.sleep(0.05)


class Hinge:
    """Two leaves that turn about a pin in the table, and a round tool that turns them."""

    LENGTH, HALF_WIDTH, TOOL, CLOSED = 0.13, 0.0175, 0.01, math.radians(50)
    NOISE = 0.0003

    def __init__(self, seed=1):
        self.random = random.Random(seed)
        self.angle = [0.4, 2.6]
        self.leaf = [[(self.random.uniform(0.03, self.LENGTH),
                       self.random.uniform(-self.HALF_WIDTH, self.HALF_WIDTH)) for _ in range(12)]
                     for _ in self.angle]
        self.table = [(x, y) for x in (-0.4, -0.2, 0.2, 0.4) for y in (-0.3, 0.25, 0.3)]

    def see(self):
        at = list(self.table)
        for angle, leaf in zip(self.angle, self.leaf):
            c, s = math.cos(angle), math.sin(angle)
            at += [(c * u - s * v, s * u + c * v) for u, v in leaf]
        noisy = [(x + self.random.gauss(0, self.NOISE), y + self.random.gauss(0, self.NOISE))
                 for x, y in at]
        return list(range(len(at))), [x for x, _ in noisy], [y for _, y in noisy]

    def begin(self, push):
        self.push, self.at, self.way, self.touched = push, 0.0, 0.0, None
        self.length = math.dist(push.start, push.end)

    def step(self, seconds):
        """Moves the tool; None while it moves, else why it was lifted."""
        way = self.push.speed * seconds
        self.at = min(self.at + way, self.length)
        (x0, y0), (x1, y1) = self.push.start, self.push.end
        x = x0 + (x1 - x0) * self.at / self.length
        y = y0 + (y1 - y0) * self.at / self.length
        blocked = not all([self.turn(i, x, y) for i in (0, 1)])
        self.way += way if self.touched is not None else 0.0
        if blocked:
            return push_status_t.BLOCKED
        if self.touched is not None and self.way >= self.push.travel:
            return push_status_t.REACHED
        if self.at >= self.length:
            return push_status_t.MISSED if self.touched is None else push_status_t.REACHED
        return None

    def turn(self, i, x, y):
        """Turns leaf i out of the tool's way; False if it cannot be."""
        reach, room = math.hypot(x, y), self.HALF_WIDTH + self.TOOL
        beside = math.remainder(math.atan2(y, x) - self.angle[i], math.tau)
        depth = room - abs(reach * math.sin(beside))
        if reach > self.LENGTH + self.TOOL or abs(beside) > math.pi / 2 or depth <= 0:
            return True
        self.touched = i
        if depth > 0.006 or reach <= room:
            return False  # against its end, or at the pin
        side = math.copysign(1.0, beside)
        angle = math.atan2(y, x) - side * math.asin(room / reach)
        other = self.angle[1 - i]
        if abs(math.remainder(angle - other, math.tau)) < self.CLOSED:
            return False
        self.angle[i] = angle
        return True


def main():
    bus = lcm.LCM(sys.argv[1]) if len(sys.argv) > 1 else lcm.LCM()
    robot = Robot(bus, Hinge())
    pressed = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: pressed.append(True))
    due = time.monotonic()
    while not pressed:
        robot.frame()
        due = max(due + 1.0 / FRAMES_PER_S, time.monotonic() - 0.1)
        while (left := due - time.monotonic()) > 0 and not pressed:
            if select.select([bus.fileno()], [], [], left)[0]:
                bus.handle()
    robot.stop(stop_t.OPERATOR)


if __name__ == "__main__":
    main()
