// libFuzzer's entry (preset fuzz): bin/replay_fuzz CORPUS -max_len=65536
#include "tests/fuzz/replay_harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    mural::fuzz::replayBytes({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
