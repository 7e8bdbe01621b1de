/* result.hpp: a value, or a text that says what is wrong, where, and what would be right. */
#ifndef GRRL_SIM_RESULT_HPP
#define GRRL_SIM_RESULT_HPP

#include <optional>
#include <string>
#include <utility>

namespace grrl_sim
{

template <typename T> struct Result {
    std::optional<T> value;
    std::string error; /* empty if and only if there is a value */

    explicit operator bool() const { return value.has_value(); }

    static Result good(T value) { return {std::optional<T>(std::move(value)), {}}; }
    static Result bad(std::string error) { return {std::nullopt, std::move(error)}; }
};

} // namespace grrl_sim

#endif
