/*
 * clairvoyant.hpp: the greedy choice of somebody who knows the truth, as a bound for all others.
 *
 * Every push of the believed model is tried in copies of the true world, under the noise that any
 * push has; the one that reveals most is taken. A joint of the object that is not believed yet
 * counts as revealed by the share of the motion that perception needs for it, at most 1.
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
