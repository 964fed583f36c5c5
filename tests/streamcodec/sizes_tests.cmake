include(GoogleTest)

add_executable(sizes_test
  sizes_compressed_block_test.cpp
  sizes_image_copy_test.cpp
  sizes_index_range_test.cpp
  sizes_parameter_counts_test.cpp
  sizes_pixel_format_test.cpp
  sizes_vertex_types_test.cpp)
target_link_libraries(sizes_test PRIVATE mural_sizes GTest::gtest_main)
gtest_discover_tests(sizes_test PROPERTIES LABELS unit)

find_library(EGL_LIBRARY EGL)
find_library(GL_LIBRARY GL)
if(EGL_LIBRARY AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/sizes_gl_context.cpp AND GL_LIBRARY)
  add_executable(sizes_gl_test
    sizes_gl_context.cpp
    sizes_guarded_memory.cpp
    sizes_compressed_gl_test.cpp
    sizes_image_read_gl_test.cpp
    sizes_image_upload_gl_test.cpp
    sizes_parameter_counts_gl_test.cpp)
mural_compile_alone(sizes_gl_test)
  target_link_libraries(sizes_gl_test PRIVATE mural_sizes GTest::gtest_main ${EGL_LIBRARY} ${GL_LIBRARY})
  gtest_discover_tests(sizes_gl_test PROPERTIES LABELS gl TIMEOUT 120)
else()
  message(STATUS "sizes_gl_test is left out: no libEGL and libGL to link with (install libgl-dev and libegl-dev)")
endif()
