/* Outgoing messages, on events and by the clock. */
#include "node.hpp"

namespace grrl_sim
{

namespace
{

constexpr int64_t repeat_us = 50000;         /* lock-step: until the agent answers */
constexpr int64_t trial_period_us = 200000;  /* real time: until the agent confirms */
constexpr int64_t status_period_us = 100000; /* real time */
constexpr int64_t frame_period_us = 33333;
constexpr int64_t finish_patience_us = 2000000;

} // namespace

void Node::note(const std::string &text) const
{
    if (config_.on_note)
        config_.on_note(text);
}

void Node::publish(const char *channel, const uint8_t *bytes, int size, const grrl_wire_why &why)
{
    if (size < 0) {
        note(why.text);
        return;
    }
    if (config_.on_message)
        config_.on_message(channel, bytes, static_cast<uint32_t>(size));
    if (lcm_publish(lcm_, channel, bytes, static_cast<unsigned>(size)) != 0)
        note("LCM could not send a message");
    sent_us_ = config_.now_us();
}

void Node::publish_trial()
{
    grrl_wire_why why;
    trial_.utime = config_.now_us();
    trial_us_ = trial_.utime;
    publish(GRRL_CHANNEL_TRIAL, bytes_,
            grrl_wire_encode_trial(&trial_, GRRL_WIRE_MAX_BYTES, bytes_, &why), why);
}

void Node::publish_points()
{
    grrl_wire_why why;
    points_.message.utime = config_.now_us();
    int size = grrl_wire_encode_points(&points_.message, GRRL_WIRE_MAX_BYTES, bytes_, &why);
    if (size >= 0 && !config_.real_time)
        burst_.emplace_back(bytes_, bytes_ + size);
    publish(GRRL_CHANNEL_POINTS, bytes_, size, why);
}

void Node::repeat_burst()
{
    for (const std::vector<uint8_t> &frame : burst_)
        publish(GRRL_CHANNEL_POINTS, frame.data(), static_cast<int>(frame.size()), {});
}

void Node::publish_picture()
{
    grrl_wire_why why;
    image_.utime = config_.now_us();
    image_bytes_.resize(GRRL_WIRE_MAX_IMAGE_BYTES);
    publish(GRRL_CHANNEL_IMAGE, image_bytes_.data(),
            grrl_wire_encode_image(&image_, GRRL_WIRE_MAX_IMAGE_BYTES, image_bytes_.data(), &why),
            why);
}

/* The receiver of an image needs to know where the tool is in it. */
void Node::publish_frame()
{
    if (config_.camera == nullptr)
        return publish_points();
    if (world_->finger_position())
        publish_push_status();
    publish_picture();
}

void Node::publish_push_status()
{
    grrl_wire_why why;
    status_.utime = config_.now_us();
    status_us_ = status_.utime;
    status_.session_id = config_.session_id;
    status_.trial_id = trial_id_;
    Vec2 tool = world_->finger_position().value_or(Vec2{});
    status_.tool[0] = static_cast<float>(tool.x);
    status_.tool[1] = static_cast<float>(tool.y);
    publish(GRRL_CHANNEL_PUSH_STATUS, bytes_,
            grrl_wire_encode_push_status(&status_, GRRL_WIRE_MAX_BYTES, bytes_, &why), why);
}

void Node::tick_lock_step(int64_t now)
{
    if (now - sent_us_ < repeat_us)
        return;
    publish_trial();
    if (!frames_flow())
        return;
    if (config_.camera != nullptr)
        publish_frame();
    else
        repeat_burst();
}

void Node::tick_real_time(int64_t now)
{
    if (agent_revision_ != trial_.revision && now - trial_us_ >= trial_period_us)
        publish_trial();
    if (now - status_us_ >= status_period_us)
        publish_push_status();
    if (!frames_flow() || now < frame_due_us_)
        return;
    send_frame();
    /* Keeps the camera's average rate; after a pause of the process, frames are skipped, not caught
     * up. */
    frame_due_us_ += frame_period_us;
    if (frame_due_us_ < now - frame_period_us)
        frame_due_us_ = now;
}

void Node::tick()
{
    if (phase_ == Phase::DONE)
        return;
    int64_t now = config_.now_us();
    if (phase_ == Phase::FINISHING && now - finishing_us_ >= finish_patience_us) {
        phase_ = Phase::DONE;
        return;
    }
    if (config_.real_time)
        tick_real_time(now);
    else
        tick_lock_step(now);
}

} // namespace grrl_sim
