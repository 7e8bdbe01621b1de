/*
 * truth.hpp: what is believed, measured by what is. On the simulator's side; an agent never sees
 * any of it.
 */
#ifndef GRRL_EXPERIMENT_TRUTH_HPP
#define GRRL_EXPERIMENT_TRUTH_HPP

#include <cstdint>
#include <utility>
#include <vector>

#include "grrl/perception/perception.h"
#include "wire.h"
#include "world.hpp"

namespace grrl_experiment
{

struct BelievedJoint {
    int a; /* links, 0 .. links - 1 */
    int b;
    int type; /* enum grrl_joint_type */
};

/* A model, whether it comes from the wire or from perception. */
struct Belief {
    int links = 0;
    std::vector<BelievedJoint> joints;
    std::vector<std::pair<int32_t, int>> features; /* id and link */
};

Belief belief_of(const grrl_model_t &model);
Belief belief_of(const grrl_model &model);

/* Of each true link the believed one that holds most of its features; -1: none holds any. */
std::vector<int> believed_links(const grrl_sim::World &world, const Belief &belief);

/* Of each true joint: whether it is believed, with its type. */
std::vector<bool> known_joints(const grrl_sim::World &world, const Belief &belief);

/* Of each believed joint: whether the object has none of this type between what the two hold. */
std::vector<bool> wrong_joints(const grrl_sim::World &world, const Belief &belief);

} // namespace grrl_experiment

#endif
