# The library's capacities. Names and defaults come from grrl/base/config.h; the cache may override
# a number (empty: the default). The result is the header that config.h looks for.
# grrl_write_capacities(CONFIG_H RESULT)
function(grrl_write_capacities config_h result)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${config_h})
    file(READ ${config_h} text)
    string(REGEX MATCHALL "#ifndef GRRL_[A-Z_]+\n#define GRRL_[A-Z_]+ [^\n]+\n#endif" defaults "${text}")
    set(names "")
    set(header "/* grrl_capacities.h: what this build of grrl holds. CMake wrote it: do not edit. */\n")
    foreach(default ${defaults})
        string(REGEX MATCH "#define (GRRL_[A-Z_]+) ([^\n]+)" line "${default}")
        set(name ${CMAKE_MATCH_1})
        set(value ${CMAKE_MATCH_2})
        foreach(other ${names}) # a default may be made of the ones above it
            string(REPLACE ${other} ${value_of_${other}} value "${value}")
        endforeach()
        math(EXPR value "${value}")
        set(${name} "" CACHE STRING "Capacity, see grrl/base/config.h (empty: the default, ${value})")
        if(NOT "${${name}}" STREQUAL "")
            set(value ${${name}})
        endif()
        if(NOT value MATCHES "^[1-9][0-9]*$")
            message(FATAL_ERROR "${name} is '${value}': it must be a plain number, 1 or more")
        endif()
        list(APPEND names ${name})
        set(value_of_${name} ${value})
        string(APPEND header "
#ifndef ${name}
#define ${name} ${value}
#elif ${name} != ${value}
#error \"${name}: grrl was built with ${value} (grrl_capacities.h); a -D or #define of the program differs: remove it, or build grrl with the same number\"
#endif
")
    endforeach()
    if(NOT names)
        message(FATAL_ERROR "${config_h}: no capacity found, this file and cmake/capacities.cmake disagree")
    endif()
    file(CONFIGURE OUTPUT ${result} CONTENT "${header}" @ONLY) # touched only where it changes
endfunction()
