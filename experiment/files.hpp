/* files.hpp: reads and writes whole files, and writes CSV fields. A reader finds either the old
 * file or the new one, never a part. */
#ifndef GRRL_EXPERIMENT_FILES_HPP
#define GRRL_EXPERIMENT_FILES_HPP

#include <cstdio>
#include <functional>
#include <optional>
#include <string>

namespace grrl_experiment
{

/* Returns nullopt if the file cannot be read. */
std::optional<std::string> read_file(const std::string &path);

/* Throws std::runtime_error. */
void write_file(const std::string &path, const std::string &text);

/* Writes a CSV file by `print` and a picture by `draw`, each unless its path is empty. Reports
 * errors on standard error; false if there was one. */
bool write_outputs(const char *program, const std::string &csv,
                   const std::function<void(std::FILE *)> &print, const std::string &svg,
                   const std::function<bool()> &draw);

/* Creates a folder and its parents. Throws std::runtime_error. */
void make_folder(const std::string &path);

/* A field of a CSV file, quoted if necessary. */
std::string csv_field(const std::string &text);

} // namespace grrl_experiment

#endif
