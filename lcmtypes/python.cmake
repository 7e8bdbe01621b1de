# grrl_python_types(OUT DEFINITION..): the package grrl_lcmtypes for Python in the folder OUT, from
# .lcm files, by ${LCM_GEN}. lcm-gen calls the package grrl, which is the name of the Python package
# in python/; its files refer to each other by relative imports alone, so another name is theirs as
# well. Sets grrl_python_types_stamp, a file to depend on.
function(grrl_python_types out)
    set(stamp ${out}/grrl_lcmtypes/__init__.py)
    add_custom_command(
        OUTPUT ${stamp}
        COMMAND ${CMAKE_COMMAND} -E rm -rf ${out} # lcm-gen adds to what is there
        COMMAND ${CMAKE_COMMAND} -E make_directory ${out}
        COMMAND ${LCM_GEN} -p --ppath ${out} ${ARGN}
        COMMAND ${CMAKE_COMMAND} -E rename ${out}/grrl ${out}/grrl_lcmtypes
        DEPENDS ${ARGN}
        COMMENT "lcm-gen: grrl_lcmtypes for Python" VERBATIM)
    set(grrl_python_types_stamp ${stamp} PARENT_SCOPE)
endfunction()
