/*
 * conditions.hpp: worlds that differ from the default one, as text: links=0.7,noise=1.4
 *
 * links, features, friction and scatter are factors; noise is in millimetres, dropout a
 * probability. size is as links, but joint friction follows, so that objects move like their larger
 * twins.
 */
#ifndef GRRL_EXPERIMENT_CONDITIONS_HPP
#define GRRL_EXPERIMENT_CONDITIONS_HPP

#include <string>
#include <vector>

#include "object.hpp"
#include "world.hpp"

namespace grrl_experiment
{

struct Conditions {
    std::string text; /* empty: the default world */
    grrl_sim::ObjectScale scale;
    grrl_sim::WorldParams world;
};

/* Returns what the text must be, or an empty one. `world` keeps what the text does not name. */
std::string parse_conditions(const std::string &text, Conditions &conditions);

/* The names that parse_conditions knows, with their ranges, for --help. */
std::string conditions_help();

/* The default world and those of the grid, one difference each. */
const std::vector<std::string> &grid_of_worlds();

} // namespace grrl_experiment

#endif
