#include <array>

#include <gtest/gtest.h>

#include "examples/data/file_bytes.hpp"
#include "examples/data/volume.hpp"
#include "tests/examples/file_makers.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::examples {
namespace {

using test::Bytes;
using test::inrOf;
using test::niftiOf;

std::string nrrd(const std::string& fields, const std::string& voxels) {
    return "NRRD0004\n# a comment\ndimension: 3\nsizes: 2 2 1\nkey:=value\n" + fields + "\n" + voxels;
}

std::string messageOf(const Result<Volume>& volume) { return volume ? "no error" : volume.error().message; }

std::vector<unsigned> values(const Volume& volume) {
    std::vector<unsigned> all;
    for (uint64_t v = 0; v < volume.voxelCount(); ++v) {
        uint16_t value = 0;
        std::memcpy(&value, volume.voxels.data() + v * volume.bytesPerVoxel, volume.bytesPerVoxel);
        all.push_back(value);
    }
    return all;
}

TEST(Volume, readsNiftiInBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const Result<Volume> read = parseVolume(niftiOf(order, {-1000, 0, 1000, 3000}), "a.nii");
        ASSERT_TRUE(read) << read.error().message;
        const Volume& volume = read.value();
        EXPECT_EQ(volume.size, (std::array<uint32_t, 3>{2, 1, 2}));
        EXPECT_EQ(volume.spacing, (std::array<double, 3>{1.5, 2, 3}));
        EXPECT_EQ(volume.bytesPerVoxel, 2u);
        EXPECT_EQ(volume.lowest, -1000);
        EXPECT_EQ(volume.highest, 3000);
        EXPECT_EQ(values(volume), (std::vector<unsigned>{0, 16384, 32768, 65535}));
    }
}

TEST(Volume, keepsSmallRangesInEightBits) {
    const Result<Volume> volume = parseVolume(niftiOf(std::endian::little, {100, 101, 102, 355}), "a.nii");
    ASSERT_TRUE(volume);
    EXPECT_EQ(volume.value().bytesPerVoxel, 1u);
    EXPECT_EQ(values(volume.value()), (std::vector<unsigned>{0, 1, 2, 255}));
}

TEST(Volume, appliesScaleAndWindow) {
    Bytes file(std::endian::little, niftiOf(std::endian::little, {0, 10, 20, 100}));
    file.put(112, 2.f).put(116, -10.f); // values -10, 10, 30, 190
    const Result<Volume> volume = parseVolume(file.text, "a.nii", {.bits = 8, .window = {{10, 60}}});
    ASSERT_TRUE(volume);
    EXPECT_EQ(values(volume.value()), (std::vector<unsigned>{0, 0, 102, 255}));
    EXPECT_EQ(volume.value().lowest, 10);
    EXPECT_EQ(volume.value().highest, 60);
}

TEST(Volume, refusesBadNifti) {
    const std::string good = niftiOf(std::endian::little, {1, 2, 3, 4});
    const auto changed = [&](size_t offset, auto value) {
        return messageOf(parseVolume(Bytes(std::endian::little, good).put(offset, value).text, "a.nii"));
    };
    EXPECT_EQ(changed(40, int16_t{2}), "a.nii: byte 40: has 2 dimensions; 3 are needed");
    EXPECT_EQ(changed(42, int16_t{-5}), "a.nii: has an axis of 0 voxels; 1 to 32768 are possible");
    EXPECT_EQ(changed(46, int16_t{32767}), "a.nii: byte 360: ends early; the voxels need 131068 bytes, and 8 exist");
    EXPECT_EQ(changed(70, int16_t{1792}), "a.nii: byte 70: voxels of type 1792 are not read");
    EXPECT_EQ(changed(108, 1e30f), "a.nii: byte 108: the voxels begin outside of the file");
    EXPECT_EQ(changed(108, std::numeric_limits<float>::quiet_NaN()),
              "a.nii: byte 108: the voxels begin outside of the file");
    EXPECT_EQ(changed(0, int32_t{540}), "a.nii: byte 0: the header is not 348 bytes long");
}

TEST(Volume, readsNrrdRawAndCompressed) {
    const std::string voxels("\x01\x02\x03\xff", 4);
    const std::string fields = "type: unsigned char\nspacings: 1 2 2.5\nencoding: ";
    for (const std::string& text : {nrrd(fields + "raw\n", voxels), nrrd(fields + "gzip\n", test::gzipped(voxels))}) {
        const Result<Volume> volume = parseVolume(text, "a.nrrd");
        ASSERT_TRUE(volume) << volume.error().message;
        EXPECT_EQ(values(volume.value()), (std::vector<unsigned>{1, 2, 3, 255}));
        EXPECT_EQ(volume.value().spacing, (std::array<double, 3>{1, 2, 2.5}));
    }
}

TEST(Volume, readsNrrdOfFloats) {
    Bytes voxels(std::endian::big);
    voxels.addAll(-1.f, 0, 1, std::numeric_limits<float>::quiet_NaN());
    const Result<Volume> volume = parseVolume(
        nrrd("type: float\nendian: big\nspace directions: (0,3,4) (2,0,0) (0,0,1)\nencoding: raw\n", voxels.text),
        "f.nrrd");
    ASSERT_TRUE(volume) << volume.error().message;
    EXPECT_EQ(values(volume.value()), (std::vector<unsigned>{0, 32768, 65535, 0}));
    EXPECT_EQ(volume.value().spacing, (std::array<double, 3>{5, 2, 1}));
}

TEST(Volume, namesLineOfBadNrrd) {
    const auto message = [](const std::string& fields, const std::string& voxels) {
        return messageOf(parseVolume(nrrd(fields, voxels), "a.nrrd"));
    };
    EXPECT_EQ(message("type: block\n", ""), "a.nrrd:6: voxels of type \"block\" are not read");
    EXPECT_EQ(message("type: short\nencoding: raw\n", ""), "a.nrrd:9: the header has no field \"endian\"");
    EXPECT_EQ(message("sizes: 2 2\n", ""), "a.nrrd:6: ends before size");
    EXPECT_EQ(message("encoding: bzip2\n", ""), "a.nrrd:6: the encoding \"bzip2\" is not read; raw and gzip are");
    EXPECT_EQ(message("type: uint8\nencoding: gzip\n", test::gzipped(std::string(5, ' '))),
              "a.nrrd: has more than 4 bytes, which is the limit");
    EXPECT_EQ(message("type: uint8\nencoding: raw\n", "abc"),
              "a.nrrd: byte 88: ends early; the voxels need 4 bytes, and 3 exist");
}

TEST(Volume, readsInr) {
    const Result<Volume> volume = parseVolume(inrOf(std::string("\0\1\2\3", 4)), "a.inr");
    ASSERT_TRUE(volume) << volume.error().message;
    EXPECT_EQ(volume.value().size, (std::array<uint32_t, 3>{2, 2, 1}));
    EXPECT_EQ(volume.value().spacing, (std::array<double, 3>{.5, .5, 1.25}));
    EXPECT_EQ(values(volume.value()), (std::vector<unsigned>{0, 1, 2, 3}));
    std::string bad = inrOf("1234");
    bad.replace(bad.find("XDIM=2"), 6, "XDIM=?");
    EXPECT_EQ(messageOf(parseVolume(bad, "a.inr")), "a.inr:2: \"?\" is no size");
    EXPECT_EQ(messageOf(parseVolume("#INRIMAGE-4#{\n##}\n", "a.inr")),
              "a.inr: the header does not end with \"##}\" after a multiple of 256 bytes");
}

TEST(Volume, readsRawVoxelsOfStatedSize) {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("v.raw", "abcdefgh", 0644);
    const Result<RawForm> form = parseRawForm("2x1x2:uint16");
    ASSERT_TRUE(form);
    const Result<Volume> volume = readRawVolume(path, form.value());
    ASSERT_TRUE(volume) << volume.error().message;
    EXPECT_EQ(volume.value().lowest, 0x6261);
    EXPECT_EQ(messageOf(readRawVolume(path, {.size = {2, 2, 3}})),
              path + ": has 8 bytes, but the stated size needs 12");
}

TEST(Volume, refusesBadForms) {
    for (const char* text : {"", "2x2", "2x2x2x2", "2x2x-1", "axbxc", "2x2x2:int7", "2x2x 2 2"})
        EXPECT_FALSE(parseRawForm(text)) << text;
    EXPECT_EQ(messageOf(parseVolume("DICM", "a.dcm")),
              "a.dcm: is no NIfTI-1, NRRD or INR file; voxels without a header need their size");
}

TEST(FileBytes, joinsGzipMembers) {
    const Result<std::string> text = gunzip(test::gzipped("one ") + test::gzipped("two"), "a.gz");
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(text.value(), "one two");
}

TEST(FileBytes, boundsDecompressedBytes) {
    const std::string bomb = test::gzipped(std::string(10'000'000, '\0'));
    const Result<std::string> text = gunzip(bomb, "a.gz", 1000);
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().message, "a.gz: has more than 1000 bytes, which is the limit");
}

TEST(FileBytes, findsDamage) {
    std::string text = test::gzipped(std::string(1000, 'x') + "tail");
    text[text.size() - 6] ^= 1; // its checksum
    EXPECT_FALSE(gunzip(text, "a.gz"));
    EXPECT_FALSE(gunzip("", "a.gz"));
    EXPECT_FALSE(gunzip("\x1f\x8b", "a.gz"));
}

} // namespace
} // namespace mural::examples
