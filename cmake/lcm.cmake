# Finds LCM: its own CMake package where there is one (1.5), otherwise the header and the library
# (Debian's 1.3.1; its lcm.pc asks for GLib's development files, which no user of LCM needs).
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
