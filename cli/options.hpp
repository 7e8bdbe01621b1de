/* options.hpp: options.h for C++, with texts in a std::string. */
#ifndef GRRL_CLI_OPTIONS_HPP
#define GRRL_CLI_OPTIONS_HPP

#include <string>

#include "cli/options.h"

inline grrl_option grrl_option_text(const char *name, const char *argument, const char *help,
                                    std::string *target)
{
    auto take = [](void *context, const char *text) -> const char * {
        *static_cast<std::string *>(context) = text;
        return nullptr;
    };
    return grrl_option_call(name, argument, help, take, target);
}

#endif
