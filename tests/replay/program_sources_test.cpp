// Encoding of program recipes, the replacement for program binaries.
#include "nodes/replay/programs/program_sources.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

ProgramSources example() {
    ProgramSources r;
    r.separable = true;
    r.shaders = {{GL_VERTEX_SHADER, "void main() {}"}, {GL_FRAGMENT_SHADER, std::string("a\0b", 3)}};
    r.outputs = {{"first", {2, 0}}, {"second", {0, 1}}};
    r.varyingMode = GL_SEPARATE_ATTRIBS;
    r.varyings = {"kept", ""};
    return r;
}

TEST(ProgramSources, roundTrips) {
    const auto back = ProgramSources::fromBytes(example().toBytes());
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->separable);
    ASSERT_EQ(back->shaders.size(), 2U);
    EXPECT_EQ(back->shaders[1].type, GLenum{GL_FRAGMENT_SHADER});
    EXPECT_EQ(back->shaders[1].text, std::string("a\0b", 3));
    EXPECT_EQ(back->outputs.at("first").color, 2U);
    EXPECT_EQ(back->outputs.at("second").index, 1U);
    EXPECT_EQ(back->varyingMode, GLenum{GL_SEPARATE_ATTRIBS});
    EXPECT_EQ(back->varyings, (std::vector<std::string>{"kept", ""}));
}

TEST(ProgramSources, isRejectedWithMissingOrAdditionalBytes) {
    std::vector<std::byte> bytes = example().toBytes();
    for (size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(ProgramSources::fromBytes(std::span(bytes).first(n))) << n;
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(ProgramSources::fromBytes(bytes));
}

TEST(ProgramSources, isRejectedWithInvalidCounts) {
    for (size_t at = 0; at + 4 <= example().toBytes().size(); ++at) {
        std::vector<std::byte> bytes = example().toBytes();
        for (size_t i = 0; i < 4; ++i) bytes[at + i] = std::byte{0xff};
        if (const auto r = ProgramSources::fromBytes(bytes)) {
            EXPECT_LE(r->shaders.size() + r->outputs.size() + r->varyings.size(), 6U);
        }
    }
}

} // namespace
} // namespace mural
