/* support.hpp: CMocka and short cuts for the tests of the simulator. */
#ifndef GRRL_TESTS_SIM_SUPPORT_HPP
#define GRRL_TESTS_SIM_SUPPORT_HPP

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <string>

extern "C" {
#include <cmocka.h>
}

#include "object.hpp"

inline grrl_sim::ObjectSpec must_build(const std::string &text)
{
    auto object = grrl_sim::object_from_text(text);
    if (!object)
        fail_msg("%s: %s", text.c_str(), object.error.c_str());
    return *object.value;
}

inline void assert_contains(const std::string &text, const std::string &part)
{
    if (text.find(part) == std::string::npos)
        fail_msg("'%s' does not contain '%s'", text.c_str(), part.c_str());
}

#endif
