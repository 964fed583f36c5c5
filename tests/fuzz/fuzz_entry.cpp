// libFuzzer's entry point for a fuzz target (preset fuzz): bin/replay_fuzz CORPUS -max_len=65536
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    mural::fuzz::fuzzOne({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
