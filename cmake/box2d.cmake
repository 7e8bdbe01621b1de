# Finds Box2D 2.4. Box2D 3 has another interface (C, ids instead of classes), so its package is
# rejected by name, whatever compatibility it claims.
find_package(box2d 2.4 CONFIG QUIET)
if(NOT box2d_FOUND OR box2d_VERSION VERSION_GREATER_EQUAL 3)
    set(found "")
    foreach(version config IN ZIP_LISTS box2d_CONSIDERED_VERSIONS box2d_CONSIDERED_CONFIGS)
        string(APPEND found "\n  found ${version}: ${config}")
    endforeach()
    if(found STREQUAL "")
        set(found "\n  found none")
    endif()
    message(FATAL_ERROR "grrl-sim needs Box2D 2.4; Box2D 3 has another interface.${found}\n"
        "Install 2.4 (Debian 12: libbox2d-dev; sources: github.com/erincatto/box2d, tag v2.4.1), name "
        "its CMake package with -Dbox2d_DIR=FOLDER if another one is found first, or build without "
        "the processes: -DGRRL_BUILD_PROCESSES=OFF.")
endif()
