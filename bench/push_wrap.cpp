/* push_wrap.cpp: stands between the parts of a push; see push.cpp. */
#include "push_wrap.hpp"

#include <cstdint>
#include <ctime>
#include <deque>

#include <unistd.h>

#include "grrl/learner/learner.h"
#include "tracker.hpp"
#include "wire.h"

class b2World; /* Box2D's */

namespace grrl_bench_push
{

namespace
{

struct Meter {
    bool runs = false;
    int counter = -1;
    double last = 0.0;
    Part now = OTHER;
    double spent[PARTS] = {};
};
Meter meter;

double reading()
{
    uint64_t count;
    timespec now{};
    if (meter.counter < 0) {
        (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
    }
    return read(meter.counter, &count, sizeof count) == sizeof count
               ? static_cast<double>(count) * 1e-6
               : meter.last;
}

/* Charges the part so far; returns it. */
Part turn_to(Part part)
{
    Part before = meter.now;
    if (meter.runs) {
        double now = reading();
        meter.spent[before] += now - meter.last;
        meter.last = now;
        meter.now = part;
    }
    return before;
}

class Scope
{
public:
    explicit Scope(Part part) : before_(turn_to(part)) {}
    ~Scope() { (void)turn_to(before_); }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

private:
    Part before_;
};

struct Subscription {
    lcm_msg_handler_t handler;
    void *user;
};
std::deque<Subscription> subscriptions; /* addresses stay */

} // namespace

void meter_start(int counter)
{
    meter.counter = counter;
    meter.runs = true;
    meter.last = reading();
}

void meter_stop(double part[PARTS])
{
    (void)turn_to(OTHER);
    meter.runs = false;
    for (int i = 0; i < PARTS; i++)
        part[i] = meter.spent[i];
}

/* In front of every handler: what it does is no longer the wire's. */
void handle(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    Scope scope(OTHER);
    const Subscription *to = static_cast<const Subscription *>(user);
    to->handler(buffer, channel, to->user);
}

} // namespace grrl_bench_push

using namespace grrl_bench_push;

/* WRAP(PART, RESULT, FUNCTION, (PARAMETERS), (ARGUMENTS)) */
#define WRAP(part, result, function, parameters, arguments)                                        \
    result __real_##function parameters;                                                           \
    result __wrap_##function parameters;                                                           \
    result __wrap_##function parameters                                                            \
    {                                                                                              \
        Scope scope(part);                                                                         \
        return __real_##function arguments;                                                        \
    }

#define WRAP_MESSAGE(type, decoded)                                                                \
    WRAP(WIRE, int, grrl_wire_encode_##type,                                                       \
         (const grrl_##type##_t *message, int capacity, uint8_t *data, grrl_wire_why *why),        \
         (message, capacity, data, why))                                                           \
    WRAP(WIRE, bool, grrl_wire_decode_##type,                                                      \
         (const void *data, uint32_t size, decoded *out, grrl_wire_why *why),                      \
         (data, size, out, why))

extern "C" {
WRAP(PERCEPTION, void, grrl_perception_observe,
     (grrl_perception * self, const grrl_frame *frame, bool pushing), (self, frame, pushing))
WRAP(PERCEPTION, grrl_status, grrl_perception_update, (grrl_perception * self), (self))
WRAP(LEARNER, grrl_status, grrl_learner_choose, (grrl_learner * self, grrl_decision *decision),
     (self, decision))
WRAP(LEARNER, grrl_status, grrl_learner_learn, (grrl_learner * self, bool ended, grrl_update *u),
     (self, ended, u))
WRAP(BOX2D, void, _ZN7b2World4StepEfii, (b2World * self, float step_s, int velocity, int place),
     (self, step_s, velocity, place))
WRAP(TRACKER, void,
     _ZNK8grrl_sim7Tracker7observeERKSt6vectorINS_4PoseESaIS2_EERNS_6RandomERNS_5FrameE,
     (const grrl_sim::Tracker *self, const std::vector<grrl_sim::Pose> &poses,
      grrl_sim::Random &noise, grrl_sim::Frame &frame),
     (self, poses, noise, frame))
WRAP(WIRE, int, lcm_handle_timeout, (lcm_t * lcm, int timeout_ms), (lcm, timeout_ms))
WRAP(WIRE, int, lcm_publish, (lcm_t * lcm, const char *channel, const void *data, unsigned size),
     (lcm, channel, data, size))
WRAP_MESSAGE(points, grrl_wire_points)
WRAP_MESSAGE(model, grrl_wire_model)
WRAP_MESSAGE(push_command, grrl_push_command_t)
WRAP_MESSAGE(push_status, grrl_push_status_t)
WRAP_MESSAGE(trial, grrl_trial_t)
WRAP_MESSAGE(decision, grrl_decision_t)
WRAP_MESSAGE(agent_status, grrl_agent_status_t)

lcm_subscription_t *__real_lcm_subscribe(lcm_t *lcm, const char *channel, lcm_msg_handler_t handler,
                                         void *user);
lcm_subscription_t *__wrap_lcm_subscribe(lcm_t *lcm, const char *channel, lcm_msg_handler_t handler,
                                         void *user);
lcm_subscription_t *__wrap_lcm_subscribe(lcm_t *lcm, const char *channel, lcm_msg_handler_t handler,
                                         void *user)
{
    subscriptions.push_back({handler, user});
    return __real_lcm_subscribe(lcm, channel, handle, &subscriptions.back());
}
}
