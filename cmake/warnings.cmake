# Warnings for all code of the tree, generated code and tests included. They are errors with the compilers that the tree
# is free of warnings with; other versions may warn about more.
if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.") OR
   (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^14\\."))
  set(warningsAreErrors ON)
else()
  set(warningsAreErrors OFF)
endif()
option(MURAL_WERROR "treat warnings as errors" ${warningsAreErrors})
add_compile_options(-Wall -Wextra -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wcast-align -Wformat=2)
if(MURAL_WERROR)
  add_compile_options(-Werror)
endif()
