# Sources that are compiled some at once: half of the time, where headers are most of it. Files that are compiled together must have
# different names in their anonymous namespaces, and a file that lacks an include may be helped by its neighbours: what each file needs
# is shown by `cmake --preset alone`, which compiles the product's own sources one by one, and is quicker for who changes one again and
# again. Tests are joined in each build. The fuzz targets, which compile some of these files anew beside the libraries, need them one by one, too.

option(MURAL_JOINED "compile the product's sources some at once" ON)

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
elseif(MURAL_JOINED)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 8)
endif()
# GCC takes files that are compiled at once for headers, in which nothing anonymous should be built on.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
