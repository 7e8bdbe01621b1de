/*
 * chooser.hpp: a policy that is not the library's: it sees the estimated model and names a push.
 *
 * chooser_policy makes it one of the library's interface, so that perception, grounding, the robot
 * and the supervisor are those of every other policy.
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

    /* Before each choice: what the model was made from, for one who foresees what comes next. */
    virtual void look(const grrl_perception & /*perception*/) {}

    /* The next push; the model has at least one body. */
    virtual Action choose(const grrl_model &model) = 0;
};

/* Asks a Chooser, which its memory points to. It learns nothing. */
extern const grrl_policy_type chooser_policy;

/* chooser_policy at work; the chooser must outlive it. */
grrl_policy policy_of(Chooser &chooser);

/* Which pushes were made since the believed links and joints last changed. */
class Tried
{
public:
    void clear() { actions_.clear(); }

    /* The model now: clears if its structure is another one, or if all its pushes were made. */
    void look(const grrl_model &model);

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
