# grrl_install(..): install(..), unless grrl is part of another project (GRRL_INSTALL).
function(grrl_install)
    if(GRRL_INSTALL)
        install(${ARGV})
    endif()
endfunction()
