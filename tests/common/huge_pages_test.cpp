// Requests for huge pages cover whole pages within the given range only.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "common/memory/huge_pages.hpp"

namespace mural {
namespace {

TEST(HugePages, requestsWholePagesWithinTheRange) {
    constexpr size_t kRoom = 4 * kHugePageBytes;
    const std::unique_ptr<void, decltype(&std::free)> block(std::aligned_alloc(kHugePageBytes, kRoom), std::free);
    auto* const at = static_cast<std::byte*>(block.get());
    const auto requested = [&](size_t from, size_t bytes) {
        const auto whole = requestHugePages({at + from, bytes});
        return std::pair(whole.empty() ? 0 : whole.data() - at, whole.size());
    };
    EXPECT_EQ(requested(0, kRoom), std::pair(std::ptrdiff_t{0}, kRoom));
    EXPECT_EQ(requested(1, kRoom - 1), std::pair(static_cast<std::ptrdiff_t>(kHugePageBytes), 3 * kHugePageBytes));
    EXPECT_EQ(requested(0, kRoom - 1), std::pair(std::ptrdiff_t{0}, 3 * kHugePageBytes));
    EXPECT_EQ(requested(1, 2 * kHugePageBytes - 1).second, kHugePageBytes);
    EXPECT_EQ(requested(1, 2 * kHugePageBytes - 2).second, 0u);
    EXPECT_EQ(requested(5, 0).second, 0u);
}

} // namespace
} // namespace mural
