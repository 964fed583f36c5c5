# Sources that are compiled some at once: half of the time, where headers are most of it. All of the sanitizers' build is built so,
# and tests are in each build. Files that are compiled together must have different names in their anonymous namespaces, and a file
# that lacks an include may be helped by its neighbours: so the product's own sources are compiled one by one in all other builds.

# Targets, or sources of the folder that calls it, whose names are for themselves.
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
endif()
