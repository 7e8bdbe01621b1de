/*
 * clairvoyant.hpp: the greedy policy that knows the truth, as a bound for all others.
 *
 * It tries every push of the estimated model in a copy of the true world, under the usual noise of
 * a push, observed by a copy of perception. It takes the push after which the most joints are
 * estimated correctly. It repeats none while the estimated structure stays the same. It reads the
 * truth and therefore runs on the simulator's side.
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

/* world: of the current trial. seed: of the noise in the copies. */
std::unique_ptr<Chooser> make_clairvoyant(std::function<const grrl_sim::World &()> world,
                                          uint64_t seed);

} // namespace grrl_experiment

#endif
