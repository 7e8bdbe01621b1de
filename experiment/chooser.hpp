/*
 * chooser.hpp: a policy of the experiment: it sees the estimated model and names a push.
 *
 * chooser_policy adapts it to the library's interface. Perception, grounding, robot and supervisor
 * are therefore the same as for every other policy.
 */
#ifndef GRRL_EXPERIMENT_CHOOSER_HPP
#define GRRL_EXPERIMENT_CHOOSER_HPP

#include <cstdint>
#include <set>
#include <utility>

#include "grrl/learner/grounding.h"
#include "grrl/learner/learner.h"
#include "grrl/perception/perception.h"

namespace grrl_experiment
{

struct Action {
    uint16_t body_number; /* grrl_body.number */
    uint8_t direction;    /* an index into grrl_direction_deg */
};

class Chooser
{
public:
    virtual ~Chooser() = default;
    virtual void begin_trial() {}

    /* Called before each choice with the perception behind the model, for choosers that simulate
     * it. */
    virtual void observe(const grrl_perception & /*perception*/) {}

    /* Returns the next push; the model has at least one body. */
    virtual Action choose(const grrl_model &model) = 0;
};

/* A policy that asks a Chooser, to which its memory points. It learns nothing. */
extern const grrl_policy_type chooser_policy;

/* A chooser_policy for this chooser, which must outlive it. */
grrl_policy policy_of(Chooser &chooser);

/* The pushes made since the estimated links and joints last changed. */
class Tried
{
public:
    void clear() { actions_.clear(); }

    /* Takes the current model. Clears if its structure has changed, or if all its
     * pushes were made. */
    void update(const grrl_model &model);

    bool has(Action action) const;
    void add(Action action);

private:
    struct Joint {
        uint16_t a;
        uint16_t b;
        uint8_t type;
        bool operator<(const Joint &other) const;
        bool operator==(const Joint &other) const;
    };
    std::set<uint16_t> bodies_;
    std::set<Joint> joints_;
    std::set<std::pair<uint16_t, uint8_t>> actions_;
};

} // namespace grrl_experiment

#endif
