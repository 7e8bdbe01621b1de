/* The course of a trial as supervisor, tracker and robot see it, and incoming messages. */
#include "node.hpp"

#include "adapter.hpp"
#include "grrl/base/settling.h"
#include "structure.hpp"

namespace grrl_sim
{

namespace
{

constexpr int64_t silence_us = 1000000;
constexpr size_t max_in_burst = 16; /* fit the receive buffer of any socket */
constexpr int max_retries = 10;     /* at a scene in which the agent finds nothing to push */

int8_t reason_on_the_wire(PushReason reason)
{
    switch (reason) {
    case PushReason::REACHED:
        return GRRL_PUSH_STATUS_T_REACHED;
    case PushReason::MISSED:
        return GRRL_PUSH_STATUS_T_MISSED;
    case PushReason::BLOCKED:
        return GRRL_PUSH_STATUS_T_BLOCKED;
    case PushReason::TIMEOUT:
        return GRRL_PUSH_STATUS_T_TIMEOUT;
    }
    return GRRL_PUSH_STATUS_T_NONE;
}

PushCommand push_of(const grrl_push_command_t &c)
{
    return command_of(
        {{c.start[0], c.start[1]}, {c.end[0], c.end[1]}, c.travel, c.speed, c.force, c.timeout});
}

} // namespace

Node::Node(lcm_t *lcm, NodeConfig config)
    : lcm_(lcm), config_(std::move(config)), subscriptions_(lcm),
      supervisor_(visible_structure(config_.object))
{
    grrl_wire_bind_points(&points_);
    agent_heard_us_ = config_.now_us();
    subscribe(GRRL_CHANNEL_PUSH_COMMAND, receive<&Node::on_command>);
    subscribe(GRRL_CHANNEL_MODEL, receive<&Node::on_model>);
    subscribe(GRRL_CHANNEL_DECISION, receive<&Node::on_decision>);
    subscribe(GRRL_CHANNEL_AGENT_STATUS, receive<&Node::on_agent_status>);
    if (config_.camera != nullptr)
        subscribe(GRRL_CHANNEL_POINTS, receive<&Node::on_points>);
    begin_trial();
}

template <void (Node::*handler)(const lcm_recv_buf_t &)>
void Node::receive(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    Node *node = static_cast<Node *>(user);
    if (node->config_.on_message)
        node->config_.on_message(channel, buffer->data, buffer->data_size);
    (node->*handler)(*buffer);
}

void Node::subscribe(const char *channel, lcm_msg_handler_t handler)
{
    /* 0 is unbounded; LCM's default of 30 silently drops the newest message. */
    (void)lcm_subscription_set_queue_capacity(subscriptions_.add(channel, handler, this), 0);
}

/* Reports the first malformed message and only counts later ones. */
bool Node::reject(const grrl_wire_why &why)
{
    if (rejected_++ == 0)
        note(why.text);
    return false;
}

/*
 * Whether a message comes from the agent of this run. Another session takes over if the known one
 * has been silent: the agent was restarted, and its trial cannot continue.
 */
bool Node::accept_session(int64_t session_id)
{
    int64_t now = config_.now_us();
    if (agent_session_id_ != 0 && session_id != agent_session_id_) {
        if (now - agent_heard_us_ < silence_us) {
            if (foreign_++ == 0)
                note("another agent answers too; it is ignored while the first one is present");
            return false;
        }
        note("the agent was restarted; its trial is aborted");
        agent_revision_ = 0;
        if (frames_flow())
            end_trial(GRRL_TRIAL_T_ABORTED);
    }
    agent_session_id_ = session_id;
    agent_heard_us_ = now;
    return true;
}

void Node::on_command(const lcm_recv_buf_t &buffer)
{
    grrl_push_command_t command;
    grrl_wire_why why;
    if (!grrl_wire_decode_push_command(buffer.data, buffer.data_size, &command, &why)) {
        reject(why);
        return;
    }
    if (command.plant_session_id == config_.session_id && accept_session(command.session_id))
        execute(command);
}

/* grrl-track's answers are for the agent; on_message needs them for a log that can be replayed. */
void Node::on_points(const lcm_recv_buf_t &) {}

void Node::on_agent_status(const lcm_recv_buf_t &buffer)
{
    grrl_agent_status_t status;
    grrl_wire_why why;
    if (!grrl_wire_decode_agent_status(buffer.data, buffer.data_size, &status, &why))
        reject(why);
    else if (status.plant_session_id == config_.session_id)
        (void)accept_session(status.session_id);
}

void Node::on_model(const lcm_recv_buf_t &buffer)
{
    grrl_wire_why why;
    if (!grrl_wire_decode_model(buffer.data, buffer.data_size, &model_, &why)) {
        reject(why);
        return;
    }
    const grrl_model_t &model = model_.message;
    if (model.session_id == agent_session_id_ && model.trial_id == trial_id_)
        judge(model);
}

void Node::on_decision(const lcm_recv_buf_t &buffer)
{
    grrl_decision_t decision;
    grrl_wire_why why;
    if (!grrl_wire_decode_decision(buffer.data, buffer.data_size, &decision, &why)) {
        reject(why);
        return;
    }
    if (decision.session_id != agent_session_id_ || decision.trial_id != trial_id_)
        return;
    decision_ = decision;
    push_if_complete();
}

bool Node::frames_flow() const
{
    return phase_ == Phase::RESTING || phase_ == Phase::DECIDING || phase_ == Phase::PUSHING;
}

void Node::begin_trial()
{
    trial_id_++;
    pushes_ = 0;
    rest_frames_ = 0;
    retries_ = 0;
    ack_cmd_seq_ = 0;
    trial_seq_ = seq_;
    command_ = {};
    decision_ = {};
    status_ = {};
    if (config_.next_object) {
        config_.object = config_.next_object(trial_id_);
        supervisor_ = Supervisor(visible_structure(config_.object));
    }
    world_ =
        std::make_unique<World>(config_.object, config_.world, trial_seed(config_.seed, trial_id_));
    if (config_.camera != nullptr)
        config_.camera->begin(*world_, trial_seed(config_.seed, trial_id_));
    phase_ = Phase::OFFER;
    trial_.judged_cmd_seq = -1;
    announce(GRRL_TRIAL_T_RUNNING, GRRL_TRIAL_T_NONE);
}

void Node::announce(int8_t phase, int8_t outcome)
{
    trial_.session_id = config_.session_id;
    trial_.trial_id = trial_id_;
    trial_.revision++;
    trial_.phase = phase;
    trial_.outcome = outcome;
    publish_trial();
}

void Node::end_trial(int8_t outcome)
{
    phase_ = Phase::ENDED;
    if (outcome != GRRL_TRIAL_T_ABORTED)
        counted_trials_++;
    announce(GRRL_TRIAL_T_ENDED, outcome);
    if (config_.on_trial)
        config_.on_trial({trial_id_, pushes_, outcome});
}

void Node::judge(const grrl_model_t &model)
{
    bool new_model = phase_ == Phase::DECIDING && model.cmd_seq == ack_cmd_seq_ &&
                     trial_.judged_cmd_seq != ack_cmd_seq_;
    if (!new_model)
        return;
    trial_.judged_cmd_seq = ack_cmd_seq_;
    grrl_graph estimated;
    if (structure_of(model, estimated) && supervisor_.judge(estimated).correct)
        end_trial(GRRL_TRIAL_T_DISCOVERED);
    else if (pushes_ >= config_.cap)
        end_trial(GRRL_TRIAL_T_CAPPED);
    else
        announce(GRRL_TRIAL_T_RUNNING, GRRL_TRIAL_T_NONE);
}

/* A command counts if it refers to the supervisor's latest message and, in lock-step, to the latest
 * frame. Anything else answers something older. */
void Node::execute(const grrl_push_command_t &command)
{
    if (command.trial_revision != trial_.revision)
        return;
    agent_revision_ = command.trial_revision;
    if (phase_ == Phase::OFFER) {
        phase_ = Phase::RESTING;
        frame_due_us_ = config_.now_us();
        advance();
    } else if (phase_ == Phase::ENDED) {
        if (counted_trials_ < config_.trials) {
            begin_trial();
        } else {
            phase_ = Phase::FINISHING;
            finishing_us_ = config_.now_us();
            announce(GRRL_TRIAL_T_FINISHED, GRRL_TRIAL_T_NONE);
        }
    } else if (phase_ == Phase::FINISHING) {
        phase_ = Phase::DONE;
    } else if (command.trial_id == trial_id_ && (config_.real_time || command.points_seq == seq_)) {
        if (phase_ != Phase::DECIDING) {
            advance();
        } else if (command.kind == GRRL_PUSH_COMMAND_T_PUSH) {
            command_ = command;
            push_if_complete();
        } else if (!config_.real_time && trial_.judged_cmd_seq == ack_cmd_seq_) {
            repeat_settling();
        }
    }
}

/* The agent is up to date but sends no push: it sees nothing to push. Further frames may help; in
 * real time they come anyway. */
void Node::repeat_settling()
{
    if (++retries_ > max_retries)
        return;
    phase_ = Phase::RESTING;
    rest_frames_ = 0;
    advance();
}

bool Node::agent_has_nothing_to_push() const
{
    return retries_ > max_retries;
}

/* A push needs its decision too, so that every log explains it, and the supervisor's judgement. */
void Node::push_if_complete()
{
    int32_t next = ack_cmd_seq_ + 1;
    if (phase_ == Phase::DECIDING && trial_.judged_cmd_seq == ack_cmd_seq_ &&
        command_.cmd_seq == next && decision_.cmd_seq == next)
        start_push();
}

void Node::start_push()
{
    ack_cmd_seq_ = command_.cmd_seq;
    pushes_++;
    retries_ = 0;
    rest_frames_ = 0;
    std::string problem = world_->begin_push(push_of(command_));
    if (problem.empty()) {
        phase_ = Phase::PUSHING;
        set_push_state(GRRL_PUSH_STATUS_T_MOVING, GRRL_PUSH_STATUS_T_NONE);
    } else {
        /* Counts as a push without effect: the agent sees that nothing moved. */
        phase_ = Phase::RESTING;
        set_push_state(GRRL_PUSH_STATUS_T_REFUSED, GRRL_PUSH_STATUS_T_BAD_COMMAND);
        note("push refused: " + problem);
    }
    advance();
}

void Node::set_push_state(int8_t state, int8_t reason)
{
    status_.agent_session_id = agent_session_id_;
    status_.cmd_seq = ack_cmd_seq_;
    status_.state = state;
    status_.reason = reason;
    publish_push_status();
}

/* In lock-step the next frames are due once the last one was answered. */
void Node::advance()
{
    if (!config_.real_time && frames_flow())
        send_burst();
}

/* What moves does not depend on the agent until it has settled: frames go out together, and only
 * the last one asks for an answer. The first of a trial goes alone, so that the agent knows where
 * the trial begins; from there it takes frames in order or not at all. */
void Node::send_burst()
{
    burst_.clear();
    while (send_frame())
        continue;
}

/* Advances the world by one frame; returns the phase to report. */
int8_t Node::advance_world()
{
    if (phase_ == Phase::PUSHING) {
        if (!world_->step_frame()) {
            phase_ = Phase::RESTING;
            rest_frames_ = 0;
            set_push_state(GRRL_PUSH_STATUS_T_DONE,
                           reason_on_the_wire(world_->push_result().reason));
        }
        return GRRL_POINTS_T_PUSHING;
    }
    if (++rest_frames_ < GRRL_SETTLING_FRAMES)
        return GRRL_POINTS_T_REST;
    phase_ = Phase::DECIDING;
    return GRRL_POINTS_T_SETTLED;
}

/* Returns whether the next one follows at once. */
bool Node::send_frame()
{
    grrl_points_t &points = points_.message;
    points.phase = advance_world();
    bool more = !config_.real_time && config_.camera == nullptr && seq_ > trial_seq_ &&
                phase_ != Phase::DECIDING && burst_.size() + 1 < max_in_burst;
    points.mode = config_.real_time ? GRRL_POINTS_T_REAL_TIME
                  : more            ? GRRL_POINTS_T_MORE
                                    : GRRL_POINTS_T_LOCK_STEP;
    points.session_id = config_.session_id;
    points.seq = ++seq_;
    points.trial_id = trial_id_;
    points.ack_cmd_seq = ack_cmd_seq_;
    points.agent_session_id = agent_session_id_;
    if (config_.camera != nullptr) {
        take_picture();
        return false;
    }
    world_->observe(frame_);
    points.n_points = copy_points(frame_, GRRL_WIRE_MAX_POINTS, points.id, points.x, points.y);
    publish_frame();
    return more;
}

/* The image carries the fields that its points would have. */
void Node::take_picture()
{
    const grrl_points_t &points = points_.message;
    config_.camera->take(*world_, picture_);
    image_.session_id = points.session_id;
    image_.seq = points.seq;
    image_.trial_id = points.trial_id;
    image_.ack_cmd_seq = points.ack_cmd_seq;
    image_.agent_session_id = points.agent_session_id;
    image_.mode = points.mode;
    image_.phase = points.phase;
    image_.width = picture_.width_px;
    image_.height = picture_.height_px;
    image_.encoding = GRRL_IMAGE_T_JPEG;
    image_.n_bytes = static_cast<int32_t>(picture_.bytes.size());
    image_.data = picture_.bytes.data();
    publish_frame();
}

} // namespace grrl_sim
