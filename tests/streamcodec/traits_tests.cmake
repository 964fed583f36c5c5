# Traits and effects of all commands, and the classes that replay, capture and filters derive from them.
add_executable(command_traits_test command_traits_test.cpp ${CMAKE_SOURCE_DIR}/interposer/encode/draw_opcodes.cpp
  ${CMAKE_SOURCE_DIR}/nodes/replay/engine/command_uses.cpp ${CMAKE_SOURCE_DIR}/nodes/replay/features/window_use.cpp)
target_link_libraries(command_traits_test PRIVATE mural_filter mural_trace mural_codec GTest::gtest_main)
gtest_discover_tests(command_traits_test PROPERTIES LABELS unit)
