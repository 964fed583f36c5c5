// Feeds arbitrary bytes to the decoder of the probes of mural doctor --network.
#include <algorithm>
#include <vector>

#include "tests/fuzz/fuzz_target.hpp"
#include "tools/mural/network/probe_datagram.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::vector<std::byte> exact(input.begin(), input.end());
    const auto probe = cli::readProbe(exact);
    if (!probe) return 0;
    must(probe->sizeBytes == exact.size(), "a probe has come whole");
    std::vector<std::byte> again(exact.size());
    cli::writeProbe(*probe, again);
    must(std::ranges::equal(std::span(again).first(20), std::span(exact).first(20)),
         "a probe's header is written in one way");
    return 1;
}

} // namespace mural::fuzz
