/* files.hpp: reads and writes whole files, and writes CSV fields. A reader finds either the old
 * file or the new one, never a part. */
#ifndef GRRL_EXPERIMENT_FILES_HPP
#define GRRL_EXPERIMENT_FILES_HPP

#include <optional>
#include <string>

namespace grrl_experiment
{

/* Returns nullopt if the file cannot be read. */
std::optional<std::string> read_file(const std::string &path);

/* Throws std::runtime_error. */
void write_file(const std::string &path, const std::string &text);

/* Creates a folder and its parents. Throws std::runtime_error. */
void make_folder(const std::string &path);

/* A field of a CSV file, quoted if necessary. */
std::string csv_field(const std::string &text);

} // namespace grrl_experiment

#endif
