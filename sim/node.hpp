/*
 * node.hpp: the simulated world on LCM: tracker or camera, robot and supervisor in one, driven by
 * events.
 *
 * The node subscribes and publishes on the caller's lcm_t and asks the caller for the time; it
 * never waits. Call lcm_handle and tick alternately, tick at least every 10 ms, until finished.
 * docs/messages.md describes the protocol.
 */
#ifndef GRRL_SIM_NODE_HPP
#define GRRL_SIM_NODE_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "camera.hpp"
#include "subscriptions.hpp"
#include "supervisor.hpp"
#include "wire.h"
#include "world.hpp"

namespace grrl_sim
{

struct TrialResult {
    int32_t trial_id;
    int pushes;
    int8_t outcome; /* GRRL_TRIAL_T_.. */
};

struct NodeConfig {
    ObjectSpec object;
    std::function<ObjectSpec(int32_t trial_id)> next_object; /* in its place, for each trial */
    WorldParams world;
    uint64_t seed = 1;
    int trials = 1; /* number of trials, not counting aborted ones */
    int cap = 100;  /* most pushes in a trial */
    bool real_time = false;
    int64_t session_id = 1; /* random, above 0, different in each run */

    /* In place of the world's own tracker: pictures go out, and grrl-track makes points of them. */
    std::shared_ptr<Camera> camera;

    std::function<int64_t()> now_us; /* required; the others may be empty */
    std::function<void(const TrialResult &)> on_trial;
    std::function<void(const std::string &)> on_note;
    /* Receives every message, published or received, in order. */
    std::function<void(const char *channel, const void *data, uint32_t size)> on_message;
};

class Node
{
public:
    /* Throws std::runtime_error if LCM refuses a subscription. */
    Node(lcm_t *lcm, NodeConfig config);
    Node(const Node &) = delete;
    Node &operator=(const Node &) = delete;

    /* Sends what is due: frames in real time, repetitions. */
    void tick();

    bool finished() const { return phase_ == Phase::DONE; }

    /* Time since the agent was last heard, or since the start. */
    int64_t agent_silent_us() const { return config_.now_us() - agent_heard_us_; }
    bool agent_known() const { return agent_session_id_ != 0; }

    /* Lock-step: the agent finds nothing to push even after repeated frames; the run cannot
     * continue. */
    bool agent_has_nothing_to_push() const;

    int64_t frames() const { return seq_; }

    /* The truth about the trial, for measurements; not for an agent. */
    const World &world() const { return *world_; }
    int64_t rejected() const { return rejected_; }
    int64_t foreign() const { return foreign_; }

private:
    enum class Phase {
        OFFER,    /* a trial is announced; the agent has not confirmed it yet */
        RESTING,  /* until the scene has settled */
        DECIDING, /* settled: model, judgement, next push */
        PUSHING,
        ENDED, /* the agent has not confirmed the end yet */
        FINISHING,
        DONE
    };

    template <void (Node::*handler)(const lcm_recv_buf_t &)>
    static void receive(const lcm_recv_buf_t *buffer, const char *channel, void *user);
    void subscribe(const char *channel, lcm_msg_handler_t handler);
    void on_command(const lcm_recv_buf_t &buffer);
    void on_model(const lcm_recv_buf_t &buffer);
    void on_decision(const lcm_recv_buf_t &buffer);
    void on_points(const lcm_recv_buf_t &buffer);
    void on_agent_status(const lcm_recv_buf_t &buffer);
    bool reject(const grrl_wire_why &why);
    bool accept_session(int64_t session_id);

    void begin_trial();
    void announce(int8_t phase, int8_t outcome);
    void end_trial(int8_t outcome);
    void judge(const grrl_model_t &model);
    void execute(const grrl_push_command_t &command);
    void push_if_complete();
    void start_push();
    void advance();
    void repeat_settling();
    int8_t advance_world();
    bool send_frame();
    void send_burst();
    void take_picture();
    void set_push_state(int8_t state, int8_t reason);

    void publish(const char *channel, const uint8_t *bytes, int size, const grrl_wire_why &why);
    void publish_trial();
    void publish_frame();
    void publish_picture();
    void publish_points();
    void repeat_burst();
    void publish_push_status();
    void tick_lock_step(int64_t now);
    void tick_real_time(int64_t now);
    void note(const std::string &text) const;
    bool frames_flow() const;

    lcm_t *lcm_;
    NodeConfig config_;
    grrl_lcm::Subscriptions subscriptions_;
    Supervisor supervisor_;
    std::unique_ptr<World> world_;

    Phase phase_ = Phase::OFFER;
    int32_t trial_id_ = 0;
    int counted_trials_ = 0;
    int pushes_ = 0;
    int rest_frames_ = 0;
    int retries_ = 0; /* further frames since the last push */
    int32_t ack_cmd_seq_ = 0;
    int64_t seq_ = 0;
    int64_t trial_seq_ = 0;                   /* the frame before the trial's first */
    std::vector<std::vector<uint8_t>> burst_; /* lock-step: frames sent since the last answer */

    grrl_trial_t trial_{};
    grrl_wire_points points_{};
    grrl_image_t image_{}; /* its data is picture_'s */
    Picture picture_;
    grrl_push_status_t status_{};
    grrl_wire_model model_{};
    grrl_push_command_t command_{}; /* the next push, once received */
    grrl_decision_t decision_{};    /* the latest decision */
    Frame frame_;
    uint8_t bytes_[GRRL_WIRE_MAX_BYTES];
    std::vector<uint8_t> image_bytes_;

    int64_t agent_session_id_ = 0;
    int64_t agent_heard_us_ = 0;
    int32_t agent_revision_ = 0;
    int64_t rejected_ = 0;
    int64_t foreign_ = 0;

    int64_t sent_us_ = 0; /* lock-step: time of the last transmission */
    int64_t trial_us_ = 0;
    int64_t status_us_ = 0;
    int64_t frame_due_us_ = 0;
    int64_t finishing_us_ = 0;
};

} // namespace grrl_sim

#endif
