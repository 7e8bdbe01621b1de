/* objects.hpp: the objects on which perception is measured by default. */
#ifndef GRRL_EXPERIMENT_PERCEPTION_OBJECTS_HPP
#define GRRL_EXPERIMENT_PERCEPTION_OBJECTS_HPP

#include <string>
#include <vector>

#include "object.hpp"

namespace grrl_experiment::perception
{

struct NamedObject {
    std::string name;
    grrl_sim::ObjectSpec spec;
};

/* All objects of the list, or those in `names`: names of the list, chains, terms or files, between
 * semicolons. */
grrl_sim::Result<std::vector<NamedObject>> select_objects(const std::string &names);

/* The names of the list, for --help. */
std::string object_names();

} // namespace grrl_experiment::perception

#endif
