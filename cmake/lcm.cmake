# Finds LCM: by its own CMake package if there is one (1.5), else by header and library (Debian's
# 1.3.1, whose lcm.pc requires GLib's development files, which no user of LCM needs).
find_package(lcm CONFIG QUIET)
add_library(grrl_lcm_transport INTERFACE)
if(TARGET lcm::lcm)
    target_link_libraries(grrl_lcm_transport INTERFACE lcm::lcm)
else()
    find_path(LCM_INCLUDE_DIR lcm/lcm.h REQUIRED)
    find_library(LCM_LIBRARY lcm REQUIRED)
    target_include_directories(grrl_lcm_transport SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
    target_link_libraries(grrl_lcm_transport INTERFACE ${LCM_LIBRARY})
endif()
find_program(LCM_GEN lcm-gen REQUIRED)
