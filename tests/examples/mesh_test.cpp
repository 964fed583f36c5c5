#include <cmath>

#include <gtest/gtest.h>

#include "examples/data/mesh.hpp"
#include "tests/examples/file_makers.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::examples {
namespace {

using test::Bytes;

const std::string kAsciiPly = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\n"
                              "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
                              "property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n"
                              "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n";

std::string binaryPly(std::endian order) {
    Bytes file(order, std::string("ply\r\nformat ") +
                          (order == std::endian::little ? "binary_little_endian" : "binary_big_endian") +
                          " 1.0\r\nelement camera 1\r\nproperty double f\r\nproperty list ushort short s\r\n"
                          "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty double z\r\n"
                          "property float nx\r\nproperty float ny\r\nproperty float nz\r\nelement face 1\r\n"
                          "property uchar flags\r\nproperty list uchar uint vertex_index\r\nend_header\r\n");
    file.add(1.5).add(uint16_t{2}).addAll(int16_t{1}, 2);
    for (const float x : {0.f, 1.f, 2.f}) file.addAll(x, x * x).add(double{3}).addAll(0.f, 2.f, 0.f);
    file.add(uint8_t{7}).add(uint8_t{3}).addAll(uint32_t{0}, 1, 2);
    return file.text;
}

std::string textStl() {
    return "solid corner\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
           "  endloop\n endfacet\n facet normal nan nan nan\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n"
           "   vertex 0 1 -0\n  endloop\n endfacet\nendsolid corner\n";
}

std::string binaryStl() {
    Bytes file(std::endian::little, std::string("solid, but binary") + std::string(63, ' '));
    file.add(uint32_t{2});
    for (const float z : {0.f, 1.f}) {
        file.addAll(0.f, 0, 1).addAll(0.f, 0, 0).addAll(1.f, 0, z).addAll(0.f, 1, 0).add(uint16_t{0});
    }
    return file.text;
}

std::string messageOf(const std::string& bytes, const std::string& file) {
    const Result<Mesh> mesh = parseMesh(bytes, file);
    return mesh ? "no error" : mesh.error().message;
}

TEST(Mesh, readsAsciiPlyWithColours) {
    const Result<Mesh> mesh = parseMesh(kAsciiPly, "square.ply");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh.value().positions.size(), 4u);
    EXPECT_EQ(mesh.value().indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.value().colours[1], (Colour{0, 255, 0, 255}));
    EXPECT_EQ(mesh.value().normals[3], (Point{0, 0, 1}));
}

TEST(Mesh, readsBinaryPlyInBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const Result<Mesh> mesh = parseMesh(binaryPly(order), "curve.ply");
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh.value().positions[2], (Point{2, 4, 3}));
        EXPECT_EQ(mesh.value().normals[0], (Point{0, 1, 0})) << "normals get the length 1";
        EXPECT_EQ(mesh.value().indices, (std::vector<uint32_t>{0, 1, 2}));
        EXPECT_TRUE(mesh.value().colours.empty());
    }
}

TEST(Mesh, namesFileAndLineOfBadText) {
    std::string text = kAsciiPly;
    text.replace(text.find("1 1 0 0 0"), 1, "x");
    EXPECT_EQ(messageOf(text, "a.ply"), "a.ply:16: \"x\" is no number");
    EXPECT_EQ(messageOf(kAsciiPly.substr(0, kAsciiPly.size() - 4), "a.ply"), "a.ply:18: ends before number");
    EXPECT_EQ(messageOf("ply\nformat ascii 1.0\nelement vertex many\n", "a.ply"),
              "a.ply:3: \"many\" is no number of elements");
    EXPECT_EQ(messageOf("ply\nformat ascii 1.0\nproperty float x\n", "a.ply"),
              "a.ply:3: a property precedes the first element");
}

TEST(Mesh, namesFileAndByteOfCutBinary) {
    const std::string whole = binaryPly(std::endian::big);
    const std::string message = messageOf(whole.substr(0, whole.size() - 1), "b.ply");
    EXPECT_EQ(message, "b.ply: byte " + std::to_string(whole.size() - 4) + ": ends before the end of its elements");
}

TEST(Mesh, refusesCountsThatTheFileDoesNotHold) {
    std::string text = kAsciiPly;
    text.replace(text.find("vertex 4"), 8, "vertex 4294967295");
    EXPECT_NE(messageOf(text, "a.ply"), "no error");
    EXPECT_EQ(messageOf("OFF\n4000000000 4000000000 0\n0 0 0\n", "a.off"), "a.off:4: ends before coordinate");
}

TEST(Mesh, refusesIndicesWithoutVertex) {
    std::string text = kAsciiPly;
    text.replace(text.find("4 0 1 2 3"), 9, "4 0 1 2 4");
    EXPECT_EQ(messageOf(text, "a.ply"), "a.ply: triangle 1 has vertex 4, but there are 4 vertices");
}

TEST(Mesh, refusesPositionsThatAreNotFinite) {
    std::string text = kAsciiPly;
    text.replace(text.find("1 1 0 0 0"), 1, "nan");
    EXPECT_EQ(messageOf(text, "a.ply"), "a.ply: vertex 2 is not finite");
}

TEST(Mesh, refusesPointsWithoutFaces) {
    EXPECT_EQ(messageOf("OFF\n1 0 0\n0 0 0\n", "p.off"),
              "p.off: has no faces; a mesh of triangles or polygons is needed");
}

TEST(Mesh, readsOffWithCommentsAndColoursOfFaces) {
    const Result<Mesh> mesh =
        parseMesh("OFF # a comment\n# another\n3 1 0\n0 0 0\n0 0 +1\n0 1e0 0\n3 0 1 2 255 0 0\n", "t.off");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh.value().positions[1], (Point{0, 0, 1}));
    EXPECT_EQ(mesh.value().triangles(), 1u);
}

TEST(Mesh, readsColoursOfOffAsIntegersOrFractions) {
    const Result<Mesh> mesh =
        parseMesh("COFF\n3 1 0\n0 0 0 255 0 10 255\n0 0 1 1.0 0.0 0.5 1.0\n0 1 0 0 0 0 255\n3 0 1 2\n", "t.off");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh.value().colours[0], (Colour{255, 0, 10, 255}));
    EXPECT_EQ(mesh.value().colours[1], (Colour{255, 0, 128, 255}));
}

TEST(Mesh, mergesEqualVerticesOfStl) {
    const Result<Mesh> text = parseMesh(textStl(), "c.stl");
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(text.value().positions.size(), 4u);
    EXPECT_EQ(text.value().triangles(), 2u);
    const Result<Mesh> binary = parseMesh(binaryStl(), "c.stl");
    ASSERT_TRUE(binary) << binary.error().message;
    EXPECT_EQ(binary.value().positions.size(), 4u);
    EXPECT_EQ(messageOf("solid\nfacet normal 0 0 1\nouter lop", "c.stl"),
              "c.stl:3: \"lop\" stands in place of \"loop\"");
}

TEST(Mesh, readsFacesOfObj) {
    const Result<Mesh> mesh = parseMesh(
        "# box\no a\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nvt 0 0\nv 0 1 0\nf 1/1 2/1/1 3//1\nf -4 -2 -1\n", "box.obj");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh.value().indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(messageOf("v 0 0 0\nf 1 1 2\n", "a.obj"),
              "a.obj:2: vertex 2 does not exist; 1 vertices precede this face");
    EXPECT_EQ(messageOf("v 0 0\n", "a.obj"), "a.obj:1: ends before coordinate");
}

TEST(Mesh, readsGzipFiles) {
    const test::TemporaryFolder folder;
    const Result<Mesh> mesh = readMesh(folder.file("square.ply.gz", test::gzipped(kAsciiPly), 0644));
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh.value().triangles(), 2u);
    const std::string cut = test::gzipped(kAsciiPly).substr(0, 60);
    const Result<Mesh> none = readMesh(folder.file("cut.ply.gz", cut, 0644));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message, folder.at("cut.ply.gz") + ": byte 60: the compressed data are cut off");
}

TEST(Mesh, refusesFilesOfOtherFormats) {
    EXPECT_EQ(messageOf("glTF", "a.glb"), "a.glb: is no PLY, OFF, STL or OBJ file");
    EXPECT_EQ(messageOf("", "a.ply"), "a.ply: is no PLY, OFF, STL or OBJ file");
    const Result<Mesh> none = readMesh("/nonexistent/a.ply");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message, "/nonexistent/a.ply: cannot be opened: No such file or directory");
}

TEST(Mesh, weighsNormalsByArea) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 1, 1, 1};
    computeNormals(mesh);
    // Areas 50 along z and 5 along x.
    EXPECT_NEAR(mesh.normals[0][0] / mesh.normals[0][2], .1, 1e-6);
    EXPECT_EQ(mesh.normals[1], (Point{0, 0, 1}));
    for (const Point& n : mesh.normals) EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-6);
}

} // namespace
} // namespace mural::examples
