/* own_plant.hpp: a tracker that knows no trials, no pushes and no phases, and a robot with a
 * session of its own, around the simulated world; with the mistakes that people make. */
#ifndef GRRL_TESTS_OWN_PLANT_HPP
#define GRRL_TESTS_OWN_PLANT_HPP

#include <cstdint>
#include <string>

#include "grrl/base/settling.h"
#include "object.hpp"
#include "wire.h"
#include "world.hpp"

/* What it does wrong; the defaults are right. */
struct PlantMistakes {
    bool no_status = false;   /* the robot never answers */
    bool never_done = false;  /* it answers MOVING and no more */
    int32_t status_trial = 0; /* what it says the trial is */
    int32_t trial_id = 0;     /* of the frames */
    int8_t phase = GRRL_POINTS_T_UNKNOWN;
    double scale = 1.0;      /* of the points */
    bool new_ids = false;    /* in every frame */
    bool renumbered = false; /* ids are places in a list that is in another order in every frame */
};

class OwnPlant
{
public:
    static constexpr int64_t tracker_session = 77;
    static constexpr int64_t robot_session = 78;

    OwnPlant(lcm_t *lcm, const std::string &object, uint64_t seed,
             const PlantMistakes &mistakes = PlantMistakes())
        : lcm_(lcm), mistakes_(mistakes),
          world_(*grrl_sim::object_from_text(object).value, grrl_sim::WorldParams(), seed)
    {
        grrl_wire_bind_points(&points_);
        subscription_ = lcm_subscribe(lcm_, GRRL_CHANNEL_PUSH_COMMAND, on_command, this);
        (void)lcm_subscription_set_queue_capacity(subscription_, 0);
    }
    ~OwnPlant() { (void)lcm_unsubscribe(lcm_, subscription_); }
    OwnPlant(const OwnPlant &) = delete;
    OwnPlant &operator=(const OwnPlant &) = delete;

    /* The next frame of 30 a second, taken at a time in microseconds. */
    void frame(int64_t utime)
    {
        utime_ = utime;
        bool was_moving = moving_;
        moving_ = moving_ && world_.step_frame();
        if (was_moving != moving_)
            report(GRRL_PUSH_STATUS_T_DONE, GRRL_PUSH_STATUS_T_REACHED);
        rest_frames_ = moving_ ? 0 : rest_frames_ + 1;
        world_.observe(frame_);
        grrl_points_t &m = points_.message;
        m.utime = utime;
        m.session_id = tracker_session;
        m.seq++;
        m.trial_id = mistakes_.trial_id;
        m.phase = mistakes_.phase;
        m.n_points = 0;
        for (const grrl_sim::TrackedFeature &feature : frame_.features)
            add(feature, static_cast<int32_t>(frame_.features.size()));
        send(GRRL_CHANNEL_POINTS, grrl_wire_encode_points(&m, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    /* Reports a move for another agent. */
    void obey_rival()
    {
        rival_ = true;
        report(GRRL_PUSH_STATUS_T_MOVING, GRRL_PUSH_STATUS_T_NONE);
    }

    /* As somebody presses the red button. */
    void stop(int8_t reason)
    {
        grrl_stop_t stop{};
        stop.utime = utime_;
        stop.session_id = robot_session;
        stop.reason = reason;
        send(GRRL_CHANNEL_STOP, grrl_wire_encode_stop(&stop, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    int pushes() const { return pushes_; }
    int commands() const { return commands_; } /* of kind PUSH, repetitions counted */
    const grrl_push_command_t &last() const { return last_; }
    /* Every push came in its turn, for this tracker, and after a rest long enough to average. */
    bool orderly() const { return orderly_; }

private:
    void add(const grrl_sim::TrackedFeature &feature, int32_t n)
    {
        grrl_points_t &m = points_.message;
        int32_t id = static_cast<int32_t>(feature.id);
        if (mistakes_.new_ids)
            id += static_cast<int32_t>(m.seq % 1000000) * 1000;
        if (mistakes_.renumbered)
            id = static_cast<int32_t>((m.n_points + m.seq * 7) % n);
        m.id[m.n_points] = id;
        m.x[m.n_points] = static_cast<float>(feature.x_m * mistakes_.scale);
        m.y[m.n_points] = static_cast<float>(feature.y_m * mistakes_.scale);
        m.n_points++;
    }

    static void on_command(const lcm_recv_buf_t *buffer, const char *, void *user)
    {
        auto *plant = static_cast<OwnPlant *>(user);
        grrl_push_command_t c;
        if (!grrl_wire_decode_push_command(buffer->data, buffer->data_size, &c, &plant->why_) ||
            c.plant_session_id != tracker_session) {
            plant->orderly_ = false;
            return;
        }
        if (c.kind != GRRL_PUSH_COMMAND_T_PUSH)
            return;
        plant->commands_++;
        if (c.cmd_seq <= plant->pushes_ && c.session_id == plant->last_.session_id)
            return;
        plant->orderly_ = plant->orderly_ && plant->rest_frames_ >= GRRL_SETTLING_FRAMES;
        plant->obey(c);
    }

    void obey(const grrl_push_command_t &c)
    {
        grrl_sim::PushCommand push;
        push.start_m = {static_cast<double>(c.start[0]), static_cast<double>(c.start[1])};
        push.end_m = {static_cast<double>(c.end[0]), static_cast<double>(c.end[1])};
        push.travel_m = static_cast<double>(c.travel);
        push.speed_m_s = static_cast<double>(c.speed);
        push.force_limit_n = static_cast<double>(c.force);
        push.timeout_s = static_cast<double>(c.timeout);
        orderly_ = orderly_ && (c.cmd_seq == pushes_ + 1 || c.session_id != last_.session_id);
        pushes_ = c.cmd_seq;
        last_ = c;
        rest_frames_ = 0;
        moving_ = world_.begin_push(push).empty();
        report(moving_ ? GRRL_PUSH_STATUS_T_MOVING : GRRL_PUSH_STATUS_T_REFUSED,
               moving_ ? GRRL_PUSH_STATUS_T_NONE : GRRL_PUSH_STATUS_T_BAD_COMMAND);
    }

    void report(int8_t state, int8_t reason)
    {
        if (mistakes_.no_status || (mistakes_.never_done && state == GRRL_PUSH_STATUS_T_DONE))
            return;
        grrl_push_status_t status{};
        status.utime = utime_;
        status.session_id = robot_session;
        status.agent_session_id = rival_ ? last_.session_id + 1 : last_.session_id;
        status.trial_id = mistakes_.status_trial;
        status.cmd_seq = pushes_;
        status.state = state;
        status.reason = reason;
        send(GRRL_CHANNEL_PUSH_STATUS,
             grrl_wire_encode_push_status(&status, GRRL_WIRE_MAX_BYTES, bytes_, &why_));
    }

    void send(const char *channel, int size)
    {
        bool sent =
            size > 0 && lcm_publish(lcm_, channel, bytes_, static_cast<unsigned>(size)) == 0;
        orderly_ = orderly_ && sent;
    }

    lcm_t *lcm_;
    PlantMistakes mistakes_;
    grrl_sim::World world_;
    grrl_sim::Frame frame_;
    lcm_subscription_t *subscription_;
    grrl_wire_points points_{};
    grrl_push_command_t last_{};
    grrl_wire_why why_;
    uint8_t bytes_[GRRL_WIRE_MAX_BYTES];
    int64_t utime_ = 0;
    int pushes_ = 0;
    int commands_ = 0;
    int rest_frames_ = 0;
    bool moving_ = false;
    bool rival_ = false;
    bool orderly_ = true;
};

#endif
