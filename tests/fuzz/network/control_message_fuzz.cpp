// Control messages of a group: an accepted message is exactly the output of encode(), byte by byte.
#include <algorithm>

#include "tests/fuzz/fuzz_target.hpp"
#include "transport/rsp/wire/control_message.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::vector<std::byte> exact(input.begin(), input.end());
    const auto message = rsp::decode(exact);
    if (!message) return 0;
    must(std::ranges::equal(rsp::encode(*message), exact), "a control message is written in one way");
    return 1;
}

} // namespace mural::fuzz
