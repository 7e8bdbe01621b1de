/*
 * clairvoyant.hpp: the greedy choice of somebody who knows the truth, as a bound for all others.
 *
 * Every push of the believed model is tried in a copy of the true world, under the noise that any
 * push has, while a copy of perception watches; the one after which most joints are rightly
 * believed is taken, and none twice while the believed structure stays the same.
 * It reads the truth and therefore lives with the simulator.
 */
#ifndef GRRL_EXPERIMENT_CLAIRVOYANT_HPP
#define GRRL_EXPERIMENT_CLAIRVOYANT_HPP

#include <cstdint>
#include <functional>
#include <memory>

#include "chooser.hpp"
#include "world.hpp"

namespace grrl_experiment
{

/* world: of the trial under way. seed: of the noise in the copies. */
std::unique_ptr<Chooser> make_clairvoyant(std::function<const grrl_sim::World &()> world,
                                          uint64_t seed);

} // namespace grrl_experiment

#endif
