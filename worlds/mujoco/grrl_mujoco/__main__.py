"""grrl-mujoco: options, files, signals and terminal output around the node."""

import argparse
import csv
import secrets
import select
import signal
import sys
import time

from .objects import ObjectError, draw_object, parse_object

POLL_S = 0.005
HINT_PERIOD_US = 5_000_000
OUTCOMES = {1: "discovered", 2: "capped", 3: "aborted"}
EPILOG = """Without --lcm-url it uses the environment variable LCM_DEFAULT_URL.
Exit status: 0 all trials done or stopped by a signal; 1 failed; 2 wrong command line.
"""


def complain(text):
    print(f"grrl-mujoco: {text}", file=sys.stderr, flush=True)


def number(kind, least, most):
    """An argument type: a finite number in a range."""

    def parse(text):
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not least <= value <= most:
            what = "a whole number" if kind is int else "a number"
            raise argparse.ArgumentTypeError(f"{text}: must be {what} from {least:g} to {most:g}")
        return value

    return parse


def parse_options(arguments):
    parser = argparse.ArgumentParser(
        prog="grrl-mujoco", allow_abbrev=False, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="A table in MuJoCo with an articulated object, an ideal camera, a finger that\n"
                    "pushes, and a supervisor, all on LCM for grrl-agent.")
    add = parser.add_argument
    add("--object", required=True, metavar="OBJECT",
        help="chain (RPR), term (D(lb, R(l1, l2))) or file; required")
    add("--trials", type=number(int, 1, 10**6), default=1, metavar="N",
        help="number of trials (1)")
    add("--cap", type=number(int, 1, 10**6), default=100, metavar="N",
        help="pushes after which a trial ends unsolved (100)")
    add("--seed", type=number(int, 0, 2**64 - 1), default=1, metavar="N",
        help="seed of dimensions, poses, noise and friction (1)")
    add("--noise", type=number(float, 0, 100), default=0.7, metavar="MM",
        help="standard deviation of a tracked point, millimetres (0.7)")
    add("--real-time", action="store_true",
        help="30 frames per second instead of lock-step with the agent")
    add("--agent-timeout", type=number(float, 0.1, 10**6), metavar="S",
        help="give up after S seconds without an agent (wait forever)")
    add("--log", metavar="FILE", help="write every message to an LCM log")
    add("--results", metavar="FILE", help="write trial,pushes,outcome lines (CSV)")
    add("--render", metavar="DIR", help="write an image of every rest to DIR (PNG; slow)")
    add("--lcm-url", metavar="URL", help="LCM provider")
    add("--quiet", action="store_true", help="print errors only")
    return parser.parse_args(arguments)


class Results:
    """Terminal output and the CSV."""

    def __init__(self, path, quiet):
        self.quiet = quiet
        self.trials = self.pushes = 0
        self.file = open(path, "w", encoding="utf-8", newline="") if path else None
        self.write("trial", "pushes", "outcome")

    def write(self, *row):
        if self.file:
            csv.writer(self.file, lineterminator="\n").writerow(row)
            self.file.flush()

    def add(self, trial_id, pushes, outcome):
        if OUTCOMES[outcome] != "aborted":
            self.trials += 1
            self.pushes += pushes
        if not self.quiet:
            mean = self.pushes / self.trials if self.trials else 0.0
            print(f"trial {trial_id}: {pushes} pushes, {OUTCOMES[outcome]}, mean {mean:.2f}",
                  flush=True)
        self.write(trial_id, pushes, OUTCOMES[outcome])


def open_lcm(url):
    import lcm

    try:
        return lcm.LCM(url) if url else lcm.LCM()
    except RuntimeError:
        complain("LCM does not start. If this machine has no network:\n"
                 "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
                 "or name another provider with --lcm-url.")
        return None


def now_us():
    """The time of day at the start plus the time since, even if the clock is set meanwhile."""
    return now_us.offset + time.monotonic_ns() // 1000


now_us.offset = time.time_ns() // 1000 - time.monotonic_ns() // 1000


stopped = False


def stop(*_):
    global stopped
    stopped = True


def loop(node, bus, options):
    """0 when all trials are done or a signal arrived, 1 when the wait for an agent timed out."""
    hint_us = 0
    while not (node.finished or stopped):
        # Waits outside LCM, whose own wait fails when a signal arrives.
        if select.select([bus.fileno()], [], [], POLL_S)[0]:
            bus.handle_timeout(0)
        node.tick()
        silent = now_us() - node.agent_heard_us
        if options.agent_timeout and silent >= options.agent_timeout * 1e6:
            complain(f"no agent for {options.agent_timeout:g} s, giving up")
            return 1
        if silent < HINT_PERIOD_US:
            hint_us = 0
        elif silent - hint_us >= HINT_PERIOD_US:
            hint_us = silent
            if not options.quiet:
                complain("waiting for an agent on the same LCM provider: start grrl-agent")
        if node.agent_is_blind:
            complain("the agent finds nothing to push, giving up: too much noise (--noise)?")
            return 1
        if node.agent_is_mute:
            complain("the agent sends no model that can be judged, giving up: what does it say?")
            return 1
    return 0


def run(options, template):
    bus = open_lcm(options.lcm_url)
    if bus is None:
        return 1
    results = Results(options.results, options.quiet)
    pictures = None
    if options.render:
        from .render import Pictures

        pictures = Pictures(options.render)
    log = None
    if options.log:
        import lcm

        log = lcm.EventLog(options.log, "w", overwrite=True)
    from .node import Node

    start = time.monotonic()
    node = Node(bus, template, seed=options.seed, trials=options.trials, cap=options.cap,
                noise_m=options.noise / 1000, real_time=options.real_time,
                session_id=secrets.randbelow(2**63 - 1) + 1, now_us=now_us,
                on_trial=results.add, on_note=(lambda text: None) if options.quiet else complain,
                on_message=log and (lambda channel, data: log.write_event(now_us(), channel, data)),
                on_rest=pictures and pictures.take)
    status = loop(node, bus, options)
    if log:
        log.close()
    if not options.quiet:
        print(f"{node.seq} frames in {time.monotonic() - start:.2f} s", flush=True)
    return status


def main(arguments):
    options = parse_options(arguments)
    try:
        template = parse_object(options.object)
        import numpy

        draw_object(template, numpy.random.default_rng(options.seed))  # loops that cannot close
    except ObjectError as error:
        complain(f"--object: {error}")
        return 2
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    try:
        return run(options, template)
    except (OSError, ObjectError, RuntimeError) as error:
        complain(str(error))
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
