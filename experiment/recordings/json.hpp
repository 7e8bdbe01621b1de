/* json.hpp: a JSON reader for the output of grrl-perceive. */
#ifndef GRRL_EXPERIMENT_RECORDINGS_JSON_HPP
#define GRRL_EXPERIMENT_RECORDINGS_JSON_HPP

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grrl_experiment::recordings
{

/* An object, an array, a text or a number; true is 1, false and null are 0. */
struct Json {
    std::string text;
    double number = 0.0;
    std::vector<Json> items;        /* of an array, and the values of an object ... */
    std::vector<std::string> names; /* ... with these names */

    /* An empty value if there is no such name. */
    const Json &operator[](const std::string &name) const;
};

/* Empty if the text is not JSON. Escapes in texts are kept as they are. */
std::optional<Json> read_json(const std::string &text);

} // namespace grrl_experiment::recordings

#endif
