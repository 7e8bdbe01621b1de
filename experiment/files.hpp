/* files.hpp: whole files, written so that a reader finds the old or the new one, never a part. */
#ifndef GRRL_EXPERIMENT_FILES_HPP
#define GRRL_EXPERIMENT_FILES_HPP

#include <optional>
#include <string>

namespace grrl_experiment
{

/* Nothing: it cannot be read. */
std::optional<std::string> read_file(const std::string &path);

/* Throws std::runtime_error. */
void write_file(const std::string &path, const std::string &text);

/* With the folders above it. Throws std::runtime_error. */
void make_folder(const std::string &path);

} // namespace grrl_experiment

#endif
