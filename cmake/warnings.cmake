# Warnings for all code of the tree, generated code and tests included. tools/check turns them into errors.
option(MURAL_WERROR "treat warnings as errors" OFF)
add_compile_options(-Wall -Wextra -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wcast-align -Wformat=2)
if(MURAL_WERROR)
  add_compile_options(-Werror)
endif()
