#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/replay_harness.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) { return replayBytes(input).commands; }

} // namespace mural::fuzz
