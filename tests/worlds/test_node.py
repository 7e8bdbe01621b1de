"""The protocol of docs/messages.md, message by message, with an agent played by the test."""

import struct
import unittest

import grrl
from grrl_mujoco import wire
from grrl_mujoco.node import MAX_LOOKS, MAX_UNJUDGED, REST_FRAMES_TO_SETTLE, Node
from grrl_mujoco.objects import parse_object

PLANT, AGENT, OTHER = 11, 22, 33


class Bus:
    """What the node needs of LCM: handlers by channel, and what was published."""

    def __init__(self):
        self.handlers, self.sent = {}, []

    def subscribe(self, channel, handler):
        self.handlers[channel] = handler
        return self

    def set_queue_capacity(self, capacity):
        assert capacity == 0

    def publish(self, channel, data):
        kinds = {wire.CHANNEL_POINTS: grrl.points_t, wire.CHANNEL_TRIAL: grrl.trial_t,
                 wire.CHANNEL_PUSH_STATUS: grrl.push_status_t}
        self.sent.append(kinds[channel].decode(data))


class Protocol(unittest.TestCase):
    def make(self, text="RP", **changes):
        self.bus, self.now, self.trials, self.notes = Bus(), 1_000_000, [], []
        values = {"seed": 1, "trials": 2, "cap": 3, "noise_m": 0.0, "real_time": False,
                  "session_id": PLANT, "now_us": lambda: self.now,
                  "on_trial": lambda *row: self.trials.append(row),
                  "on_note": self.notes.append}
        self.node = Node(self.bus, parse_object(text), **{**values, **changes})

    def newest(self, kind):
        return next(m for m in reversed(self.bus.sent) if isinstance(m, kind))

    def say(self, channel, message):
        self.bus.handlers[channel](channel, message.encode())

    def command(self, kind=grrl.push_command_t.WAIT, **changes):
        command = grrl.push_command_t()
        values = {"session_id": AGENT, "plant_session_id": PLANT, "kind": kind,
                  "points_seq": self.node.seq, "trial_id": self.newest(grrl.trial_t).trial_id,
                  "trial_revision": self.newest(grrl.trial_t).revision, "cmd_seq": 0}
        for name, value in {**values, **changes}.items():
            setattr(command, name, value)
        self.say(wire.CHANNEL_PUSH_COMMAND, command)

    def push(self, cmd_seq, **changes):
        x, y, _ = self.node.world.poses()[0]
        values = {"cmd_seq": cmd_seq, "start": [x - 0.1, y], "end": [x + 0.1, y], "travel": 0.02,
                  "speed": 0.1, "force": 10.0, "timeout": 2.5}
        self.command(grrl.push_command_t.PUSH, **{**values, **changes})

    def model(self, cmd_seq, joints, n_links=3, **changes):
        model = grrl.model_t()
        model.session_id, model.trial_id, model.cmd_seq = AGENT, self.node.trial_id, cmd_seq
        model.n_links, model.n_joints = n_links, len(joints)
        for name in ("link_number", "link_x", "link_y", "link_angle", "link_length", "link_width",
                     "link_size"):
            setattr(model, name, [0] * n_links)
        for name in ("joint_probability", "joint_x", "joint_y", "joint_angle", "joint_lower",
                     "joint_upper"):
            setattr(model, name, [0] * len(joints))
        model.joint_type = [int(kind == "P") for kind, _, _ in joints]
        model.joint_a, model.joint_b = [j[1] for j in joints], [j[2] for j in joints]
        for name, value in changes.items():
            setattr(model, name, value)
        self.say(wire.CHANNEL_MODEL, model)

    def settle(self):
        """Answers frames until one is settled."""
        for _ in range(400):
            points = self.newest(grrl.points_t)
            if points.phase == points.SETTLED:
                return points
            self.command()
        self.fail("nothing settles")

    def start_trial(self):
        self.command()
        return self.settle()

    def test_a_trial_from_offer_to_end(self):
        self.make()
        trial = self.newest(grrl.trial_t)
        self.assertEqual((trial.trial_id, trial.revision, trial.phase, trial.judged_cmd_seq),
                         (1, 1, grrl.trial_t.RUNNING, -1))
        self.assertEqual(len(self.bus.sent), 1)  # no frame before the agent agrees
        points = self.start_trial()
        self.assertEqual((points.seq, points.ack_cmd_seq), (REST_FRAMES_TO_SETTLE, 0))
        self.model(0, [], n_links=1)
        trial = self.newest(grrl.trial_t)
        self.assertEqual((trial.revision, trial.phase, trial.judged_cmd_seq),
                         (2, grrl.trial_t.RUNNING, 0))
        self.push(1)
        self.assertEqual(self.newest(grrl.push_status_t).state, grrl.push_status_t.MOVING)
        points = self.newest(grrl.points_t)
        self.assertEqual((points.phase, points.ack_cmd_seq, points.agent_session_id),
                         (grrl.points_t.PUSHING, 1, AGENT))
        self.settle()
        self.assertEqual(self.newest(grrl.push_status_t).state, grrl.push_status_t.DONE)
        self.model(1, [("P", 2, 0), ("R", 0, 1)])
        trial = self.newest(grrl.trial_t)
        self.assertEqual((trial.phase, trial.outcome, trial.judged_cmd_seq),
                         (grrl.trial_t.ENDED, grrl.trial_t.DISCOVERED, 1))
        self.assertEqual(self.trials, [(1, 1, grrl.trial_t.DISCOVERED)])
        self.command()
        trial = self.newest(grrl.trial_t)
        self.assertEqual((trial.trial_id, trial.phase, trial.judged_cmd_seq),
                         (2, grrl.trial_t.RUNNING, -1))

    def test_finishes_after_the_last_trial(self):
        self.make(trials=1)
        self.start_trial()
        self.model(0, [("R", 0, 1), ("P", 1, 2)])
        self.command()
        self.assertEqual(self.newest(grrl.trial_t).phase, grrl.trial_t.FINISHED)
        self.assertFalse(self.node.finished)
        self.command()
        self.assertTrue(self.node.finished)

    def test_capped(self):
        self.make(cap=1)
        self.start_trial()
        self.model(0, [], n_links=1)
        self.push(1)
        self.settle()
        self.model(1, [], n_links=1)
        self.assertEqual(self.newest(grrl.trial_t).outcome, grrl.trial_t.CAPPED)

    def test_a_command_acts_once(self):
        self.make()
        self.start_trial()
        self.model(0, [], n_links=1)
        self.push(1)
        frames = self.node.seq
        for _ in range(3):
            self.push(1, points_seq=frames - 1)  # the same again, late
        self.assertEqual((self.node.pushes, self.node.seq), (1, frames))
        self.settle()
        self.push(1)  # settled, but this push is done
        self.assertEqual(self.node.pushes, 1)
        self.push(3)  # and that one is not next
        self.assertEqual(self.node.pushes, 1)
        self.push(2)  # not before the model after push 1 is judged
        self.assertEqual(self.node.pushes, 1)

    def test_a_model_is_judged_once_and_only_the_newest(self):
        self.make()
        self.start_trial()
        self.model(1, [("R", 0, 1), ("P", 1, 2)])
        self.model(0, [], n_links=1)
        revision = self.newest(grrl.trial_t).revision
        self.model(0, [("R", 0, 1), ("P", 1, 2)])
        self.assertEqual(self.newest(grrl.trial_t).revision, revision)
        self.assertEqual(self.trials, [])

    def test_an_old_revision_or_frame_is_no_answer(self):
        self.make()
        self.command(trial_revision=0)
        self.assertEqual(self.node.seq, 0)
        self.command()
        self.command(points_seq=self.node.seq + 1)
        self.command(points_seq=0)
        self.command(trial_id=2)
        self.command(plant_session_id=PLANT + 1)
        self.assertEqual(self.node.seq, 1)

    def test_repeats_until_it_is_answered(self):
        self.make()
        self.now += 60_000
        self.node.tick()
        self.assertEqual([m.revision for m in self.bus.sent], [1, 1])
        self.command()
        self.now += 60_000
        self.node.tick()
        frames = [m for m in self.bus.sent if isinstance(m, grrl.points_t)]
        self.assertEqual([m.seq for m in frames], [1, 1])
        self.assertEqual((frames[0].id, frames[0].x), (frames[1].id, frames[1].x))

    def test_a_bad_push_is_refused_and_counts(self):
        self.make()
        self.start_trial()
        self.model(0, [], n_links=1)
        before = self.node.world.data.qpos.tobytes()
        self.push(1, force=50.0)
        status = self.newest(grrl.push_status_t)
        self.assertEqual((status.state, status.reason, status.cmd_seq),
                         (grrl.push_status_t.REFUSED, grrl.push_status_t.BAD_COMMAND, 1))
        self.assertEqual(self.settle().ack_cmd_seq, 1)
        self.assertEqual((self.node.pushes, self.node.world.data.qpos.tobytes()), (1, before))
        self.assertIn("force limit", self.notes[0])

    def test_another_agent_waits_until_the_first_is_silent(self):
        self.make()
        self.start_trial()
        frames = self.node.seq
        self.command(session_id=OTHER)
        self.assertEqual((self.node.seq, self.node.foreign), (frames, 1))
        self.now += 1_100_000
        self.command(session_id=OTHER)
        self.assertEqual(self.newest(grrl.trial_t).outcome, grrl.trial_t.ABORTED)
        self.assertEqual(self.node.counted_trials, 0)
        self.command(session_id=OTHER)
        self.assertEqual(self.newest(grrl.trial_t).trial_id, 2)

    def test_an_agent_that_sees_nothing_to_push_is_given_up(self):
        self.make()
        self.start_trial()
        self.model(0, [], n_links=0)
        for look in range(MAX_LOOKS + 1):
            self.assertFalse(self.node.agent_is_blind, look)
            self.command()
            if not self.node.agent_is_blind:
                self.settle()
        self.assertTrue(self.node.agent_is_blind)

    def test_an_agent_without_a_model_stalls_nothing(self):
        self.make()
        for n in range(MAX_UNJUDGED):
            self.assertFalse(self.node.agent_is_mute)
            self.start_trial()
            for _ in range(13):
                self.now += 5_000_000
                if self.newest(grrl.trial_t).outcome == grrl.trial_t.NONE:
                    self.command()
                self.node.tick()
            trial = self.newest(grrl.trial_t)
            self.assertEqual((trial.trial_id, trial.outcome), (n + 1, grrl.trial_t.ABORTED))
            self.command()
        self.assertTrue(self.node.agent_is_mute)
        self.assertEqual(self.node.counted_trials, 0)

    def test_real_time_frames_come_by_the_clock(self):
        self.make(real_time=True)
        self.now += 1_000_000
        self.node.tick()
        self.assertEqual(self.node.seq, 0)  # not before the agent agrees
        self.command()
        for _ in range(60):
            self.now += 5_000
            self.node.tick()
        self.assertIn(self.node.seq, (9, 10))
        self.assertEqual(self.newest(grrl.points_t).mode, grrl.points_t.REAL_TIME)

    def test_damaged_messages_have_no_effect(self):
        self.make()
        command = grrl.push_command_t()
        command.session_id, command.plant_session_id = AGENT, PLANT
        command.trial_id = command.trial_revision = 1
        good = command.encode()
        receive = self.bus.handlers[wire.CHANNEL_PUSH_COMMAND]
        for n in range(len(good)):
            receive(wire.CHANNEL_PUSH_COMMAND, good[:n])
        receive(wire.CHANNEL_PUSH_COMMAND, good + b"\0")
        command.speed = float("nan")
        receive(wire.CHANNEL_PUSH_COMMAND, command.encode())
        self.assertEqual((self.node.rejected, self.node.seq, len(self.notes)),
                         (len(good) + 2, 0, 1))
        receive(wire.CHANNEL_PUSH_COMMAND, good)
        self.assertEqual(self.node.seq, 1)

    def test_counts_of_a_model_are_not_trusted(self):
        self.make()
        self.start_trial()
        model = grrl.model_t()
        model.session_id, model.trial_id = AGENT, 1
        good = model.encode()
        for count in (-1, 33, 2**31 - 1):
            for offset in (8 + 24, 8 + 28, 8 + 32):
                bad = good[:offset] + struct.pack(">i", count) + good[offset + 4:]
                self.bus.handlers[wire.CHANNEL_MODEL](wire.CHANNEL_MODEL, bad)
        self.assertEqual(self.node.rejected, 9)
        self.model(0, [("R", 0, 3)])  # a link that is not there
        self.assertEqual(self.node.rejected, 10)
        self.assertEqual(self.newest(grrl.trial_t).judged_cmd_seq, -1)


if __name__ == "__main__":
    unittest.main()
