/*
 * object_folder.hpp: the objects that come with grrl, by name.
 *
 * They lie in a folder that the running program finds from where it lies itself, so that an
 * installed copy may be moved; the build tree has a link at the same place.
 */
#ifndef GRRL_SIM_OBJECT_FOLDER_HPP
#define GRRL_SIM_OBJECT_FOLDER_HPP

#include <string>

namespace grrl_sim
{

/* The folder; empty where the program cannot tell where it lies. */
std::string object_folder();

/* The path of wooden-toy.grrl for "wooden-toy"; empty if there is none, or it is no such name. */
std::string object_path(const std::string &name);

/* "garden-shears, scissors, wooden-toy"; empty if there are none. */
std::string object_names();

} // namespace grrl_sim

#endif
