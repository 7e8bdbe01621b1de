# The library's capacities. Names, profiles and defaults come from grrl/base/config.h; the cache names
# the profile (GRRL_PROFILE) and may override a number (empty: the profile's). The result is the
# header that config.h looks for.
# grrl_write_capacities(CONFIG_H RESULT)
function(grrl_write_capacities config_h result)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${config_h})
    set(profiles tiny small default large) # in the order of GRRL_PROFILED
    set(GRRL_PROFILE default CACHE STRING "Capacities: tiny, small, default or large, see docs/firmware.md")
    set_property(CACHE GRRL_PROFILE PROPERTY STRINGS ${profiles})
    list(FIND profiles "${GRRL_PROFILE}" profile)
    if(profile EQUAL -1)
        message(FATAL_ERROR "GRRL_PROFILE is '${GRRL_PROFILE}': it must be tiny, small, default or large")
    endif()
    file(READ ${config_h} text)
    string(REGEX MATCHALL "#ifndef GRRL_[A-Z_]+\n#define GRRL_[A-Z_]+ [^\n]+\n#endif" defaults "${text}")
    set(names "")
    set(header "/* grrl_capacities.h: what this build of grrl holds. CMake wrote it: do not edit. */\n")
    foreach(default ${defaults})
        string(REGEX MATCH "#define (GRRL_[A-Z_]+) ([^\n]+)" line "${default}")
        set(name ${CMAKE_MATCH_1})
        set(value ${CMAKE_MATCH_2})
        if(value MATCHES "^GRRL_PROFILED\\((.*)\\)$")
            string(REPLACE ", " ";" of_profiles "${CMAKE_MATCH_1}")
            list(GET of_profiles ${profile} value)
        endif()
        foreach(other ${names}) # a default may be made of the ones above it
            string(REPLACE ${other} ${value_of_${other}} value "${value}")
        endforeach()
        math(EXPR value "${value}")
        set(${name} "" CACHE STRING "Capacity, see grrl/base/config.h (empty: that of the profile)")
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
