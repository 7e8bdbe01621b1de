/* subscriptions.hpp: subscriptions to LCM channels that end with their owner. */
#ifndef GRRL_LCMTYPES_SUBSCRIPTIONS_HPP
#define GRRL_LCMTYPES_SUBSCRIPTIONS_HPP

#include <stdexcept>
#include <string>
#include <vector>

#include <lcm/lcm.h>

namespace grrl_lcm
{

class Subscriptions
{
public:
    explicit Subscriptions(lcm_t *lcm) : lcm_(lcm) {}
    ~Subscriptions()
    {
        for (lcm_subscription_t *subscription : all_)
            (void)lcm_unsubscribe(lcm_, subscription);
    }
    Subscriptions(const Subscriptions &) = delete;
    Subscriptions &operator=(const Subscriptions &) = delete;

    /* Throws std::runtime_error if LCM refuses. */
    lcm_subscription_t *add(const char *channel, lcm_msg_handler_t handler, void *user)
    {
        lcm_subscription_t *subscription = lcm_subscribe(lcm_, channel, handler, user);
        if (subscription == nullptr)
            throw std::runtime_error(std::string("LCM refused the subscription to ") + channel);
        all_.push_back(subscription);
        return subscription;
    }

private:
    lcm_t *lcm_;
    std::vector<lcm_subscription_t *> all_;
};

} // namespace grrl_lcm

#endif
