#include <gtest/gtest.h>

#include "examples/volume/slabs.hpp"
#include "examples/volume/transfer_function.hpp"

namespace mural::examples {
namespace {

// A volume whose voxels are their own positions: x + 10 y + 100 z.
Volume positions(std::array<uint32_t, 3> size, uint32_t bytesPerVoxel) {
    Volume volume;
    volume.size = size;
    volume.spacing = {1, 2, 3};
    volume.bytesPerVoxel = bytesPerVoxel;
    for (uint32_t z = 0; z < size[2]; ++z) {
        for (uint32_t y = 0; y < size[1]; ++y) {
            for (uint32_t x = 0; x < size[0]; ++x) {
                const uint32_t value = x + 10 * y + 100 * z;
                for (uint32_t k = 0; k < bytesPerVoxel; ++k)
                    volume.voxels.push_back(static_cast<std::byte>(value >> 8 * k));
            }
        }
    }
    return volume;
}

TEST(Slabs, putsLongestAxisLast) {
    for (const uint32_t bytes : {1u, 2u}) {
        const SlicedVolume sliced = sliceAlongLongestAxis(positions({5, 3, 2}, bytes));
        EXPECT_EQ(sliced.axes, (std::array<uint32_t, 3>{2, 1, 0}));
        EXPECT_EQ(sliced.volume.size, (std::array<uint32_t, 3>{2, 3, 5}));
        EXPECT_EQ(sliced.volume.spacing, (std::array<double, 3>{3, 2, 1}));
        EXPECT_EQ(sliced.bytesPerSlice(), 6 * bytes);
        const auto slice = sliced.slicesOf(3, 4); // x = 3 of the original
        EXPECT_EQ(slice[0], std::byte{3});
        EXPECT_EQ(slice[1 * bytes], std::byte{103});
        EXPECT_EQ(slice[2 * bytes], std::byte{13});
    }
}

TEST(Slabs, keepsVolumesWhoseLastAxisIsLongest) {
    const Volume volume = positions({3, 3, 3}, 1);
    const SlicedVolume sliced = sliceAlongLongestAxis(volume);
    EXPECT_EQ(sliced.axes, (std::array<uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(sliced.volume.voxels, volume.voxels);
}

TEST(Slabs, coversEachSliceOnceAndStoresOneMore) {
    for (const uint32_t slices : {1u, 7u, 100u}) {
        for (const int parts : {1, 2, 4, 13}) {
            uint32_t next = 0;
            for (int part = 0; part < parts; ++part) {
                const Slab slab = slabOf({double(part) / parts, double(part + 1) / parts}, slices);
                EXPECT_EQ(slab.first, next);
                next = slab.end;
                if (slab.empty()) continue;
                EXPECT_EQ(slab.storedFirst, slab.first == 0 ? 0 : slab.first - 1);
                EXPECT_EQ(slab.storedEnd, slab.end == slices ? slices : slab.end + 1);
            }
            EXPECT_EQ(next, slices);
        }
    }
}

TEST(Slabs, ordersByDistanceFromTheEye) {
    EXPECT_EQ(distanceOfSlab(-3, 0, 1), 3);
    EXPECT_EQ(distanceOfSlab(.5, 0, 1), 0);
    EXPECT_EQ(distanceOfSlab(4, 0, 1), 3);
    EXPECT_LT(distanceOfSlab(-3, 0, 1), distanceOfSlab(-3, 1, 2));
    EXPECT_GT(distanceOfSlab(4, 0, 1), distanceOfSlab(4, 1, 2));
}

TEST(TransferFunction, interpolatesBetweenPoints) {
    const Result<TransferFunction> function = parseTransferFunction("0.2:000000:0,0.6:ff8000:1");
    ASSERT_TRUE(function) << function.error().message;
    const TransferTable table = function.value().table();
    const auto entry = [&](size_t at) {
        return std::array{table[4 * at], table[4 * at + 1], table[4 * at + 2], table[4 * at + 3]};
    };
    EXPECT_EQ(entry(0), (std::array<uint8_t, 4>{0, 0, 0, 0}));
    EXPECT_EQ(entry(51), (std::array<uint8_t, 4>{0, 0, 0, 0}));
    EXPECT_EQ(entry(102), (std::array<uint8_t, 4>{127, 64, 0, 127}));
    EXPECT_EQ(entry(255), (std::array<uint8_t, 4>{255, 128, 0, 255}));
    EXPECT_EQ(TransferFunction{}.table(), TransferTable{});
}

TEST(TransferFunction, stepsAtEqualValues) {
    const Result<TransferFunction> function = parseTransferFunction("0:ffffff:0,0.5:ffffff:0,0.5:ffffff:1,1:ffffff:1");
    ASSERT_TRUE(function);
    const TransferTable table = function.value().table();
    EXPECT_EQ(table[4 * 127 + 3], 0);
    EXPECT_EQ(table[4 * 128 + 3], 255);
}

TEST(TransferFunction, hasValidPresets) {
    for (const char* name : {"grey", "brain", "bone", "labels"}) EXPECT_TRUE(parseTransferFunction(name)) << name;
}

TEST(TransferFunction, refusesBadPoints) {
    for (const char* text : {"", "rainbow", "0.5", "0.5:ff:1", "2:ffffff:1", "0:ffffff:nan", "0:fffffg:1",
                             "0:ffffff:1,", "0.5:ffffff:1,0.4:ffffff:1"})
        EXPECT_FALSE(parseTransferFunction(text)) << text;
    EXPECT_EQ(parseTransferFunction("rainbow").error().message,
              "\"rainbow\" is no point of a transfer function such as 0.5:ffcc99:0.3; the names are grey, brain, bone, "
              "labels");
}

} // namespace
} // namespace mural::examples
