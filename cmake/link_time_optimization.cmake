# Link-time optimization of single libraries. A received datagram passes through a dozen small functions in as many files,
# 77 000 times per second at 1 Gbit/s; inlining across them saves 4 % of a receiver's CPU time (docs/decisions/0010). Each
# program with such a library takes some seconds longer to link, so only release builds use it.

include(CheckIPOSupported)
check_ipo_supported(RESULT MURAL_IPO_SUPPORTED LANGUAGES CXX)
string(FIND "${CMAKE_CXX_FLAGS}" "-fsanitize" MURAL_SANITIZER_POSITION)

function(mural_link_time_optimize target)
  if(MURAL_IPO_SUPPORTED AND MURAL_UNITY AND NOT MURAL_SANITIZE AND MURAL_SANITIZER_POSITION EQUAL -1)
    set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION ON)
  endif()
endfunction()
