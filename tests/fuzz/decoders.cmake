# Replay of malformed streams. With the preset fuzz (clang, MURAL_FUZZ) libFuzzer searches. Everywhere else the corpus
# and a few seconds of random mutations run as a test.
#
# The main function of all fuzz targets.
add_library(fuzz_regression OBJECT fuzz_regression.cpp)
add_executable(replay_fuzz_regression $<TARGET_OBJECTS:fuzz_regression> replay_fuzz.cpp replay_harness.cpp fake_gl.cpp)
target_link_libraries(replay_fuzz_regression PRIVATE mural_replay)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/run)
add_test(NAME replay_fuzz_regression COMMAND replay_fuzz_regression --seconds 3 ${CMAKE_CURRENT_SOURCE_DIR}/corpus
         WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/run)
set_tests_properties(replay_fuzz_regression PROPERTIES LABELS "fuzz;sanitize" TIMEOUT 120)

# Creates the corpus with the encoder: bin/replay_fuzz_seeds tests/fuzz/corpus
add_executable(replay_fuzz_seeds replay_fuzz_seeds.cpp)
target_link_libraries(replay_fuzz_seeds PRIVATE encoder_harness)

if(MURAL_FUZZ)
  # All code that reads the stream is compiled again with coverage. GL function pointers are called through one function
  # that does nothing, which the `function` check rejects.
  file(GLOB replaySources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/nodes/replay/*/*.cpp ${CMAKE_SOURCE_DIR}/streamcodec/sizes/*.cpp)
  add_executable(replay_fuzz fuzz_entry.cpp replay_fuzz.cpp replay_harness.cpp fake_gl.cpp ${replaySources} ${MURAL_GENERATED}/replay_dispatch.cpp
                 ${MURAL_GENERATED}/gl_functions.cpp ${MURAL_GENERATED}/opcode_names.cpp)
  add_dependencies(replay_fuzz mural_generated)
  target_link_libraries(replay_fuzz PRIVATE mural_replay)
  set(fuzzFlags -fsanitize=fuzzer,address,undefined -fno-sanitize=function -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_compile_options(replay_fuzz PRIVATE ${fuzzFlags})
  target_link_options(replay_fuzz PRIVATE ${fuzzFlags})
endif()

include(fuzz_target.cmake)
add_subdirectory(network)
add_subdirectory(codecs)
add_subdirectory(config)
add_subdirectory(control)
add_subdirectory(trace)
add_subdirectory(delta)
add_subdirectory(exchange)
add_subdirectory(frame_transfer)
add_subdirectory(examples)
add_subdirectory(objects)
add_subdirectory(page)
add_subdirectory(preview)
add_subdirectory(remote_wall)
