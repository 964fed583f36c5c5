// Alignment and resizing of pixel memory.
#include "compositor/image/pixel_bytes.hpp"

#include <cstdint>
#include <gtest/gtest.h>

#include "compositor/image/plane.hpp"

namespace mural::compositor {
namespace {

uintptr_t placeOf(const PixelBytes& bytes) { return reinterpret_cast<uintptr_t>(bytes.data()); }

TEST(PixelBytes, alignToCacheLinesAndHugePages) {
    for (size_t sizeBytes = 1; sizeBytes < size_t{20} << 20; sizeBytes = sizeBytes * 3 + 5) {
        const PixelBytes bytes(sizeBytes);
        EXPECT_EQ(placeOf(bytes) % 64, 0u) << sizeBytes;
        const size_t largeBytes = sizeBytes < size_t{4} << 20 ? 1 : size_t{2} << 20;
        EXPECT_EQ(placeOf(bytes) % largeBytes, 0u) << sizeBytes;
    }
}

// Small and large allocations differ: each is freed as it was allocated.
TEST(PixelBytes, preserveContentWhenResized) {
    PixelBytes bytes(100, std::byte{7});
    for (const size_t sizeBytes : {size_t{5} << 20, size_t{300}, size_t{9} << 20}) {
        bytes.resize(sizeBytes);
        bytes.shrink_to_fit();
        for (size_t i = 0; i < 100; ++i) ASSERT_EQ(bytes[i], std::byte{7}) << sizeBytes << ' ' << i;
    }
    EXPECT_EQ(placeOf(Plane(PlaneFormat::Rgba8, 1920, 1080).bytes()) % (size_t{2} << 20), 0u);
}

} // namespace
} // namespace mural::compositor
