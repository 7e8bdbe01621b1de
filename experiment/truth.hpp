/*
 * truth.hpp: compares an estimated structure, from any method, with the true one. It runs on the
 * simulator's side; an agent never sees any of it.
 *
 * An estimated link represents the true link to which most of its features belong. While true links
 * have not moved relative to one another, one estimated link may hold several of them, which is
 * correct.
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

/* A feature on the background or on no known link. */
enum { no_link = -1 };

struct Estimate {
    int links = 0;
    std::vector<EstimatedJoint> joints;
    std::vector<std::pair<int32_t, int>>
        features; /* id, and link or no_link; only features that were seen */
};

Estimate estimate_of(const grrl_model_t &model);
Estimate estimate_of(const grrl_model &model);

/* For each true link, the estimated link that holds most of its features; no_link if none holds
 * any. */
std::vector<int> estimated_links(const grrl_sim::World &world, const Estimate &estimate);

/* For each true joint, whether the estimate has it, with its type. */
std::vector<bool> known_joints(const grrl_sim::World &world, const Estimate &estimate);

/* For each estimated joint, whether the object has no joint of this type between the true links. */
std::vector<bool> wrong_joints(const grrl_sim::World &world, const Estimate &estimate);

} // namespace grrl_experiment

#endif
