// Detection of FragCoord in SPIR-V modules.
#include <array>
#include <cstdint>
#include <gtest/gtest.h>

#include "nodes/shaders/spirv_module.hpp"
#include "tests/programs/support/spirv_modules.hpp"

namespace mural::shaders {
namespace {

namespace modules = programs::modules;

template <size_t N> bool reads(const uint32_t (&words)[N], size_t used = N) {
    return moduleReadsFragCoord(std::as_bytes(std::span(words, used)));
}

TEST(SpirvModule, detectsReadsOfFragCoord) {
    EXPECT_TRUE(reads(modules::kFragment));
    EXPECT_FALSE(reads(modules::kVertex));
    EXPECT_FALSE(reads(modules::kCompute));
    EXPECT_FALSE(reads(modules::kCounting));
}

TEST(SpirvModule, assumesReadsInUnreadableModules) {
    EXPECT_TRUE(moduleReadsFragCoord({}));
    EXPECT_TRUE(reads(modules::kVertex, 4));
    EXPECT_TRUE(reads(modules::kVertex, 6)); // within an instruction
    uint32_t swapped[] = {0x03022307, 0, 0, 0, 0};
    EXPECT_TRUE(reads(swapped));
    uint32_t endless[] = {0x07230203, 0x10000, 0, 1, 0, 71};
    EXPECT_TRUE(reads(endless));
}

} // namespace
} // namespace mural::shaders
