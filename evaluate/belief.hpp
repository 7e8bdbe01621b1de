/*
 * belief.hpp: what some method of perception makes of a table, and how right it is.
 *
 * The same for every method, so that they can be compared: which feature is on which body, and
 * which joints there are. A body stands for the link most of whose features it has; while links
 * have not moved against one another, several have the same body, which is right.
 */
#ifndef GRRL_EVALUATE_BELIEF_HPP
#define GRRL_EVALUATE_BELIEF_HPP

#include <vector>

#include "world.hpp"

namespace grrl_evaluate
{

struct BelievedJoint {
    int a; /* bodies */
    int b;
    grrl_joint_type type;
    double probability;
};

struct Belief {
    int n_bodies = 0;
    std::vector<int> body_of; /* by the id of a feature, no_body or unseen */
    std::vector<BelievedJoint> joints;
};

enum { no_body = -1, unseen = -2 };

/* How right a belief is. */
struct Verdict {
    bool wrong_joint = false;  /* a joint where there is none, or of the other type */
    bool false_split = false;  /* a body that is a part of a link, or the table's */
    bool missed_joint = false; /* some joint is not believed */
    bool exact = false;        /* links and joints are as in truth */
    int features = 0;          /* seen, on links that have a body, or on the table */
    int misplaced = 0;         /* of these in another body than they should be */
    int sure = 0;              /* joints with a probability of at least 0.95 .. */
    int sure_and_right = 0;    /* .. and those which are */
};

Verdict judge(const Belief &belief, const grrl_sim::World &world);

} // namespace grrl_evaluate

#endif
