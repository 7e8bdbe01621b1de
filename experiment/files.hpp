/* files.hpp: whole files, written so that a reader finds the old or the new one, never a part; and
 * fields of CSV. */
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

/* A field of a CSV file, between quotation marks where it needs them. */
std::string csv_field(const std::string &text);

} // namespace grrl_experiment

#endif
