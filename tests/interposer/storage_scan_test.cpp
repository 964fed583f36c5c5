// Detection of storage blocks that a GLSL source may write.
#include <gtest/gtest.h>

#include <string_view>

#include "interposer/memory/shader_storage_scan.hpp"

namespace mural {
namespace {

bool mayWrite(std::initializer_list<std::string_view> pieces) {
    StorageScan scan;
    for (const std::string_view piece : pieces) scan.feed(piece.data(), piece.size());
    return scan.mayWrite();
}

TEST(StorageScan, findsBlocksThatMayBeWritten) {
    EXPECT_TRUE(mayWrite({"buffer V { uint v; };"}));
    EXPECT_TRUE(mayWrite({"layout(std430, binding = 2) coherent\nrestrict buffer V\n{ uint v[]; } b[2];"}));
    EXPECT_TRUE(mayWrite({"readonly buffer A { int a; }; buffer B { int b; };"}));
    EXPECT_TRUE(mayWrite({"buffer V { readonly uint v; uint w; };"}));
    EXPECT_TRUE(mayWrite({"readonly uniform image2D i; buffer V { uint v; };"}));
}

TEST(StorageScan, ignoresReadOnlyBlocks) {
    EXPECT_FALSE(mayWrite({"readonly buffer V { uint v; };"}));
    EXPECT_FALSE(mayWrite({"buffer layout(binding = 1) readonly V { uint v; };"}));
    EXPECT_FALSE(mayWrite({"layout(std430) buffer; uniform U { vec4 u; }; void main() { }"}));
    EXPECT_FALSE(mayWrite({"uniform samplerBuffer buffers; vec4 buffer2() { return vec4(1); }"}));
    EXPECT_FALSE(mayWrite({""}));
}

TEST(StorageScan, assumesWritesInMacrosAndIncludes) {
    EXPECT_TRUE(mayWrite({"#define STORAGE buffer\nreadonly STORAGE V { uint v; };"}));
    EXPECT_TRUE(mayWrite({"#  include </blocks>\nvoid main() { }"}));
    EXPECT_TRUE(mayWrite({"#ifdef A\nreadonly\n#endif\nbuffer V { uint v; };"}));
    EXPECT_TRUE(mayWrite({"#define A \\\n buffer\n"}));
    EXPECT_FALSE(mayWrite({"#define A readonly\nvoid f() { }"}));
}

TEST(StorageScan, ignoresComments) {
    EXPECT_FALSE(mayWrite({"// buffer V {\n/* buffer V { */ /*/ buffer V { */ void f() { }"}));
    EXPECT_FALSE(mayWrite({"// goes on \\\nbuffer V {\nvoid f() { }"}));
    EXPECT_TRUE(mayWrite({"/* readonly */ buffer V { uint v; };"}));
    EXPECT_TRUE(mayWrite({"/**/buffer V/**/{ uint v; };"}));
    EXPECT_TRUE(mayWrite({"a = b / c; // readonly\nbuffer V { uint v; };"}));
}

TEST(StorageScan, joinsConsecutiveTexts) {
    EXPECT_TRUE(mayWrite({"layout(binding = 0) buf", "fer V", " { uint v; };"}));
    EXPECT_FALSE(mayWrite({"read", "only buffer V", " { uint v; };"}));
    EXPECT_FALSE(mayWrite({"/", "/ buffer V {"}));
}

} // namespace
} // namespace mural
