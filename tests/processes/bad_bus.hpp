/* bad_bus.hpp: what lies between agents and simulators in the tests: it loses, repeats and delays
 * messages as its seed says. */
#ifndef GRRL_TESTS_BAD_BUS_HPP
#define GRRL_TESTS_BAD_BUS_HPP

#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "grrl/base/random.h"
#include "wire.h"

namespace bad_bus
{

/* Probabilities of a message, each way. */
struct Faults {
    double loss = 0.0;
    double twice = 0.0;
    double late = 0.0; /* by up to late_us, so that others overtake it */
    int64_t late_us = 120000;
    uint64_t seed = 1;
};

struct Counts {
    int64_t passed = 0;
    int64_t lost = 0;
    int64_t twice = 0;
    int64_t late = 0;
};

class BadBus
{
public:
    /* Between two providers: the simulators' and the agents'. */
    BadBus(lcm_t *plants, lcm_t *agents, const Faults &faults) : faults_(faults)
    {
        grrl_random_init(&random_, faults.seed, 77);
        ways_[0] = {this,
                    plants,
                    agents,
                    nullptr,
                    {GRRL_CHANNEL_POINTS, GRRL_CHANNEL_TRIAL, GRRL_CHANNEL_PUSH_STATUS}};
        ways_[1] = {this,
                    agents,
                    plants,
                    nullptr,
                    {GRRL_CHANNEL_PUSH_COMMAND, GRRL_CHANNEL_MODEL, GRRL_CHANNEL_DECISION,
                     GRRL_CHANNEL_AGENT_STATUS}};
        for (Way &way : ways_) {
            way.subscription = lcm_subscribe(way.from, ".*", on_message, &way);
            if (way.subscription == nullptr)
                throw std::runtime_error("LCM refused the subscription");
            (void)lcm_subscription_set_queue_capacity(way.subscription, 0);
        }
    }
    ~BadBus()
    {
        for (Way &way : ways_)
            (void)lcm_unsubscribe(way.from, way.subscription);
    }
    BadBus(const BadBus &) = delete;
    BadBus &operator=(const BadBus &) = delete;

    /* Sends on what is due. */
    void tick(int64_t now_us)
    {
        now_us_ = now_us;
        std::vector<Delayed> waiting;
        waiting.swap(delayed_);
        for (const Delayed &message : waiting)
            if (message.due_us <= now_us)
                publish(message);
            else
                delayed_.push_back(message);
    }

    const Counts &counts() const { return counts_; }

private:
    struct Way {
        BadBus *bus;
        lcm_t *from;
        lcm_t *to;
        lcm_subscription_t *subscription;
        std::set<std::string> channels;
    };
    struct Delayed {
        lcm_t *to;
        int64_t due_us;
        std::string channel;
        std::vector<uint8_t> data;
    };

    static void on_message(const lcm_recv_buf_t *buffer, const char *channel, void *user)
    {
        Way *way = static_cast<Way *>(user);
        if (way->channels.count(channel) != 0)
            way->bus->take(*way, channel, *buffer);
    }

    bool happens(double probability)
    {
        return grrl_random_below(&random_, 1000000) < probability * 1e6;
    }

    void take(const Way &way, const char *channel, const lcm_recv_buf_t &buffer)
    {
        const uint8_t *bytes = static_cast<const uint8_t *>(buffer.data);
        Delayed message = {way.to, now_us_, channel, {bytes, bytes + buffer.data_size}};
        bool lost = happens(faults_.loss);
        bool twice = happens(faults_.twice);
        bool late = happens(faults_.late);
        counts_.lost += lost;
        if (lost)
            return;
        counts_.passed++;
        counts_.twice += twice;
        counts_.late += late;
        if (twice)
            publish(message);
        if (late) {
            message.due_us +=
                1 + grrl_random_below(&random_, static_cast<uint32_t>(faults_.late_us));
            delayed_.push_back(message);
        } else {
            publish(message);
        }
    }

    void publish(const Delayed &message)
    {
        (void)lcm_publish(message.to, message.channel.c_str(), message.data.data(),
                          static_cast<unsigned>(message.data.size()));
    }

    Faults faults_;
    grrl_random random_{};
    int64_t now_us_ = 0;
    Way ways_[2];
    std::vector<Delayed> delayed_;
    Counts counts_;
};

} // namespace bad_bus

#endif
