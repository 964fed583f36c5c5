# Libraries whose files are optimised as one when a program is linked: the way of a datagram goes through a dozen small functions of as
# many files, 77 000 times a second at 1 Gbit/s. Each program that holds such a library takes some seconds more to link.
# Not where a build is for finding faults.

include(CheckIPOSupported)
check_ipo_supported(RESULT MURAL_LINK_TIME_IS_THERE LANGUAGES CXX)
string(FIND "${CMAKE_CXX_FLAGS}" "-fsanitize" MURAL_SANITIZER_AT)

function(mural_optimise_as_one target)
  if(MURAL_LINK_TIME_IS_THERE AND MURAL_JOINED AND NOT MURAL_SANITIZE AND MURAL_SANITIZER_AT EQUAL -1)
    set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION ON)
  endif()
endfunction()
