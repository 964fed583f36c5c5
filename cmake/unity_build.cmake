# Unity builds: several sources per compiler run. They halve the compile time of the whole tree, because headers dominate it
# (docs/decisions/0009). They are off by default: with one source per run, a one-line change compiles one file.
#
# Sources of one unity batch share a translation unit, so names in their anonymous namespaces must differ. A missing include can
# go unnoticed in a unity build; the preset `dev` finds it.

option(MURAL_UNITY "compile several sources per compiler run, for builds of the whole tree" OFF)

# Excludes targets, or sources of the calling folder, from unity builds.
function(mural_compile_alone)
  foreach(name IN LISTS ARGN)
    if(TARGET ${name})
      set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
    else()
      set_source_files_properties(${name} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()

if(MURAL_SANITIZE)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
elseif(MURAL_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
endif()
# GCC treats the sources of a unity batch as headers and warns about their anonymous namespaces.
add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>)
# GCC 12 collects garbage from a heap of 128 MiB on, which takes a sixth of the CPU time of a unity batch. A limit of 1 GiB
# adds a quarter to the memory of the batch (docs/decisions/0009).
if(MURAL_SANITIZE OR MURAL_UNITY)
  add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:--param=ggc-min-heapsize=1048576>)
endif()
