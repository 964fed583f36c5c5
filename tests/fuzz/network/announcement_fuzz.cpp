// Feeds arbitrary bytes to the decoder of node announcements.
#include <algorithm>

#include "tests/fuzz/fuzz_target.hpp"
#include "transport/discovery/announcement.hpp"

namespace mural::fuzz {

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::vector<std::byte> exact(input.begin(), input.end());
    const auto a = decodeAnnouncement(exact);
    if (!a) return 0;
    must(a->name.size() <= kMaxAnnouncedText && a->version.size() <= kMaxAnnouncedText, "texts have their limit");
    must(std::ranges::equal(encode(*a), exact), "an announcement is written in one way");
    return 1;
}

} // namespace mural::fuzz
