/*
 * truth.hpp: an estimate of a structure, by whatever method, measured by the true one. On the
 * simulator's side; an agent never sees any of it.
 *
 * A link of the estimate stands for the true link most of whose features it has. While true links
 * have not moved against one another, several have the same one, which is right.
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

struct EstimatedJoint {
    int a; /* links, 0 .. links - 1 */
    int b;
    int type; /* enum grrl_joint_type */
    double probability;
};

/* The link of a feature on the background, or on nothing known. */
enum { no_link = -1 };

struct Estimate {
    int links = 0;
    std::vector<EstimatedJoint> joints;
    std::vector<std::pair<int32_t, int>> features; /* id, and link or no_link; those seen */
};

Estimate estimate_of(const grrl_model_t &model);
Estimate estimate_of(const grrl_model &model);

/* Of each true link the estimated one that holds most of its features; no_link: none holds any. */
std::vector<int> estimated_links(const grrl_sim::World &world, const Estimate &estimate);

/* Of each true joint: whether the estimate has it, with its type. */
std::vector<bool> known_joints(const grrl_sim::World &world, const Estimate &estimate);

/* Of each estimated joint: whether the object has none of this type between what the two hold. */
std::vector<bool> wrong_joints(const grrl_sim::World &world, const Estimate &estimate);

} // namespace grrl_experiment

#endif
