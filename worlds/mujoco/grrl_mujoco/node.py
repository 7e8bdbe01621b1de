"""Tracker, robot and supervisor on LCM: the course of a trial, as described in docs/messages.md.

The node is driven by events: the caller hands it messages by LCM's handlers and calls tick at least
every 10 ms until `finished`. It waits for nothing.
"""

import grrl

from . import wire
from .supervisor import Supervisor
from .world import World

REST_FRAMES_TO_SETTLE = 10
MAX_LOOKS = 10  # at a scene in which the agent finds nothing to push
SILENCE_US = 1_000_000
REPEAT_US = 50_000  # lock-step: until the agent answers
TRIAL_PERIOD_US = 200_000  # real time: until the agent confirms
STATUS_PERIOD_US = 100_000
FRAME_PERIOD_US = 33_333
FINISH_PATIENCE_US = 2_000_000
MODEL_PATIENCE_US = 60_000_000  # an emulated controller takes seconds
MAX_UNJUDGED = 3  # trials in a row aborted because no model arrived

# OFFER and ENDED wait for the agent to confirm; RESTING and PUSHING send frames; DECIDING waits for
# model, judgement and the next push.
OFFER, RESTING, DECIDING, PUSHING, ENDED, FINISHING, DONE = range(7)
FRAMES_FLOW = (RESTING, DECIDING, PUSHING)


class Node:
    """Callbacks: on_trial(trial_id, pushes, outcome), on_note(text), on_message(channel, data),
    on_rest(trial_id, pushes, world)."""

    def __init__(self, lcm, template, *, seed, trials, cap, noise_m, real_time, session_id, now_us,
                 on_trial, on_note, on_message=None, on_rest=None):
        self.lcm, self.template = lcm, template
        self.seed, self.trials, self.cap, self.noise_m = seed, trials, cap, noise_m
        self.real_time, self.session_id, self.now_us = real_time, session_id, now_us
        self.on_trial, self.on_note = on_trial, on_note
        self.on_message, self.on_rest = on_message, on_rest
        self.supervisor = Supervisor(*template.visible())
        self.trial_id = self.counted_trials = self.seq = self.rejected = self.foreign = 0
        self.trial = grrl.trial_t()
        self.trial.session_id = session_id
        self.points = grrl.points_t()
        self.status = grrl.push_status_t()
        self.agent_session_id = self.agent_revision = 0
        self.agent_heard_us = now_us()
        self.sent_us = self.trial_us = self.status_us = self.frame_due_us = 0
        self.settled_us = self.finishing_us = 0
        self.unjudged = 0
        for channel, kind, handler in (
            (wire.CHANNEL_PUSH_COMMAND, grrl.push_command_t, self._take_command),
            (wire.CHANNEL_MODEL, grrl.model_t, self._take_model),
            (wire.CHANNEL_AGENT_STATUS, grrl.agent_status_t, self._take_agent_status),
            (wire.CHANNEL_DECISION, None, None),  # for the log only
        ):
            subscription = lcm.subscribe(channel, self._receiver(kind, handler))
            subscription.set_queue_capacity(0)  # unbounded: LCM drops the newest of 30 silently
        self._begin_trial()

    @property
    def finished(self):
        return self.phase == DONE

    @property
    def agent_is_blind(self):
        """Lock-step: it finds nothing to push even after many frames; the run cannot continue."""
        return self.looks > MAX_LOOKS

    @property
    def agent_is_mute(self):
        """No valid model arrives from it; the run cannot continue."""
        return self.unjudged >= MAX_UNJUDGED

    # Incoming messages.

    def _receiver(self, kind, handler):
        def receive(channel, data):
            if self.on_message:
                self.on_message(channel, data)
            if kind is None:
                return
            try:
                message = wire.decode(kind, data)
            except wire.WireError as error:
                self.rejected += 1
                if self.rejected == 1:  # later ones only count
                    self.on_note(str(error))
                return
            handler(message)

        return receive

    def _known_agent(self, session_id):
        """Whether a message comes from the agent of this run. Another session takes over if the
        known one has been silent: it was restarted, and its trial cannot continue."""
        now = self.now_us()
        if self.agent_session_id not in (0, session_id):
            if now - self.agent_heard_us < SILENCE_US:
                self.foreign += 1
                if self.foreign == 1:
                    self.on_note("another agent answers, too, and is ignored while the first one "
                                 "is there")
                return False
            self.on_note("the agent was restarted, its trial is aborted")
            self.agent_revision = 0
            if self.phase in FRAMES_FLOW:
                self._end_trial(grrl.trial_t.ABORTED)
        self.agent_session_id = session_id
        self.agent_heard_us = now
        return True

    def _take_command(self, command):
        if command.plant_session_id == self.session_id and self._known_agent(command.session_id):
            self._obey(command)

    def _take_agent_status(self, status):
        if status.plant_session_id == self.session_id:
            self._known_agent(status.session_id)

    def _take_model(self, model):
        if model.session_id == self.agent_session_id and model.trial_id == self.trial_id:
            self._judge(model)

    # The supervisor.

    def _begin_trial(self):
        self.trial_id += 1
        self.pushes = self.rest_frames = self.looks = self.ack_cmd_seq = 0
        self.status = grrl.push_status_t()
        self.world = World(self.template, [self.seed, self.trial_id], self.noise_m)
        self.phase = OFFER
        self.trial.judged_cmd_seq = -1
        self._announce(grrl.trial_t.RUNNING, grrl.trial_t.NONE)

    def _announce(self, phase, outcome):
        self.trial.trial_id = self.trial_id
        self.trial.revision += 1
        self.trial.phase = phase
        self.trial.outcome = outcome
        self._publish_trial()

    def _end_trial(self, outcome):
        self.phase = ENDED
        if outcome != grrl.trial_t.ABORTED:
            self.counted_trials += 1
        self._announce(grrl.trial_t.ENDED, outcome)
        self.on_trial(self.trial_id, self.pushes, outcome)

    def _judge(self, model):
        """A model counts once for each push: the newest, with the scene at rest."""
        if (self.phase != DECIDING or model.cmd_seq != self.ack_cmd_seq
                or self.trial.judged_cmd_seq == self.ack_cmd_seq):
            return
        self.trial.judged_cmd_seq = self.ack_cmd_seq
        self.unjudged = 0
        if self.supervisor.correct(model):
            self._end_trial(grrl.trial_t.DISCOVERED)
        elif self.pushes >= self.cap:
            self._end_trial(grrl.trial_t.CAPPED)
        else:
            self._announce(grrl.trial_t.RUNNING, grrl.trial_t.NONE)

    # The robot.

    def _obey(self, command):
        """A command counts if it refers to the supervisor's latest message and, in lock-step, to
        the latest frame. Anything else answers something older."""
        if command.trial_revision != self.trial.revision:
            return
        self.agent_revision = command.trial_revision
        if self.phase == OFFER:
            self.phase = RESTING
            self.frame_due_us = self.now_us()
            self._advance()
        elif self.phase == ENDED:
            if self.counted_trials < self.trials:
                self._begin_trial()
            else:
                self.phase = FINISHING
                self.finishing_us = self.now_us()
                self._announce(grrl.trial_t.FINISHED, grrl.trial_t.NONE)
        elif self.phase == FINISHING:
            self.phase = DONE
        elif command.trial_id == self.trial_id and (
                self.real_time or command.points_seq == self.seq):
            self._continue(command)

    def _continue(self, command):
        judged = self.trial.judged_cmd_seq == self.ack_cmd_seq
        if self.phase != DECIDING:
            self._advance()
        elif command.kind == grrl.push_command_t.PUSH:
            if judged and command.cmd_seq == self.ack_cmd_seq + 1:
                self._start_push(command)
        elif judged and not self.real_time:
            self.looks += 1  # it sees nothing to push; further frames may help
            if not self.agent_is_blind:
                self.phase = RESTING
                self.rest_frames = 0
                self._advance()

    def _start_push(self, command):
        self.ack_cmd_seq = command.cmd_seq
        self.pushes += 1
        self.looks = self.rest_frames = 0
        problem = self.world.begin_push(command)
        if problem:  # counts as a push without effect: the agent sees that nothing moved
            self.phase = RESTING
            self._set_push_state(grrl.push_status_t.REFUSED, grrl.push_status_t.BAD_COMMAND)
            self.on_note(f"push refused: {problem}")
        else:
            self.phase = PUSHING
            self._set_push_state(grrl.push_status_t.MOVING, grrl.push_status_t.NONE)
        self._advance()

    def _set_push_state(self, state, reason):
        self.status.agent_session_id = self.agent_session_id
        self.status.cmd_seq = self.ack_cmd_seq
        self.status.state = state
        self.status.reason = reason
        self._publish_push_status()

    # The tracker.

    def _advance(self):
        """In lock-step the next frame is due once the last one was answered."""
        if not self.real_time and self.phase in FRAMES_FLOW:
            self._send_frame()

    def _move_on(self):
        """Advances the world by one frame; returns the phase to report."""
        if self.phase == PUSHING:
            if not self.world.step_frame():
                self.phase = RESTING
                self.rest_frames = 0
                self._set_push_state(grrl.push_status_t.DONE, self.world.reason)
            return grrl.points_t.PUSHING
        self.rest_frames += 1
        if self.rest_frames < REST_FRAMES_TO_SETTLE:
            return grrl.points_t.REST
        if self.phase != DECIDING:
            self.settled_us = self.now_us()
            if self.on_rest:
                self.on_rest(self.trial_id, self.pushes, self.world)
        self.phase = DECIDING
        return grrl.points_t.SETTLED

    def _send_frame(self):
        points = self.points
        points.phase = self._move_on()
        points.mode = grrl.points_t.REAL_TIME if self.real_time else grrl.points_t.LOCK_STEP
        self.seq += 1
        points.session_id = self.session_id
        points.seq = self.seq
        points.trial_id = self.trial_id
        points.ack_cmd_seq = self.ack_cmd_seq
        points.agent_session_id = self.agent_session_id
        points.id, points.x, points.y = self.world.observe()
        points.n_points = len(points.id)
        self._publish_points()

    # Outgoing messages.

    def _publish(self, channel, message):
        message.utime = self.now_us()
        data = message.encode()
        if self.on_message:
            self.on_message(channel, data)
        self.lcm.publish(channel, data)
        self.sent_us = message.utime

    def _publish_trial(self):
        self.trial_us = self.now_us()
        self._publish(wire.CHANNEL_TRIAL, self.trial)

    def _publish_points(self):
        self._publish(wire.CHANNEL_POINTS, self.points)

    def _publish_push_status(self):
        self.status_us = self.now_us()
        self.status.session_id = self.session_id
        self.status.trial_id = self.trial_id
        self.status.tool = list(self.world.finger_position() or (0.0, 0.0))
        self._publish(wire.CHANNEL_PUSH_STATUS, self.status)

    def tick(self):
        """Sends what is due by the clock: frames in real time, repetitions."""
        now = self.now_us()
        if self.phase == DONE:
            return
        if self.phase == FINISHING and now - self.finishing_us >= FINISH_PATIENCE_US:
            self.phase = DONE
        elif self._waits_for_a_model(now):
            self.unjudged += 1
            self.on_note("no valid model arrives; the trial is aborted")
            self._end_trial(grrl.trial_t.ABORTED)
        elif self.real_time:
            self._tick_real_time(now)
        elif now - self.sent_us >= REPEAT_US:
            self._publish_trial()
            if self.phase in FRAMES_FLOW:
                self._publish_points()

    def _waits_for_a_model(self, now):
        """Whether an agent that is present has not sent a model for too long."""
        return (self.phase == DECIDING and self.trial.judged_cmd_seq != self.ack_cmd_seq
                and now - self.settled_us >= MODEL_PATIENCE_US
                and now - self.agent_heard_us < SILENCE_US)

    def _tick_real_time(self, now):
        if self.agent_revision != self.trial.revision and now - self.trial_us >= TRIAL_PERIOD_US:
            self._publish_trial()
        if now - self.status_us >= STATUS_PERIOD_US:
            self._publish_push_status()
        if self.phase not in FRAMES_FLOW or now < self.frame_due_us:
            return
        self._send_frame()
        self.frame_due_us += FRAME_PERIOD_US
        # After a pause of the process, frames are skipped, not caught up.
        if self.frame_due_us < now - FRAME_PERIOD_US:
            self.frame_due_us = now
