// The choice of a section's compression, with simulated times, sizes and links.
#include <gtest/gtest.h>

#include "streamcodec/delta/entropy/section_codec_selector.hpp"

namespace mural::delta {
namespace {

// Both codings measured: Zstandard 3 ns per byte with ratio 0.5, LZ4 1 ns with 0.7.
SectionCodecSelector measuredChoice(double zstdRatio = 0.5, double lz4Ratio = 0.7) {
    SectionCodecSelector choice;
    for (int i = 0; i < 20; ++i) {
        const size_t size = 10'000;
        choice.measured(Coding::Zstd, size, static_cast<size_t>(size * zstdRatio), 30'000);
        choice.measured(Coding::Lz4, size, static_cast<size_t>(size * lz4Ratio), 10'000);
    }
    return choice;
}

TEST(SectionCodecSelector, compressesMoreOnSlowerLinks) {
    SectionCodecSelector choice = measuredChoice();
    EXPECT_EQ(choice.choose(1000, 80), Coding::Zstd); // 100 Mbit/s
    EXPECT_EQ(choice.choose(1000, 4), Coding::Lz4);
    EXPECT_EQ(choice.choose(1000, 0.8), Coding::Raw); // 10 Gbit/s
}

TEST(SectionCodecSelector, sendsIncompressibleDataRaw) {
    SectionCodecSelector choice = measuredChoice(1.001, 1.004);
    EXPECT_EQ(choice.choose(1000, 80), Coding::Raw);
}

TEST(SectionCodecSelector, measuresBothCodingsRepeatedly) {
    SectionCodecSelector choice;
    for (const Coding coding : {Coding::Zstd, Coding::Lz4}) {
        for (int time = 0; time < 3; ++time) {
            EXPECT_EQ(choice.choose(1000, 8), coding);
            EXPECT_TRUE(choice.wantsTime(coding, 1000));
            choice.measured(coding, 1 << 16, 1 << 16, 1000);
        }
    }
    int compressed = 0;
    for (int i = 0; i < 1000; ++i) compressed += choice.choose(1000, 8) != Coding::Raw;
    EXPECT_GE(compressed, 2);
    EXPECT_LE(compressed, 8);
}

TEST(SectionCodecSelector, measuresLz4OnAPartOfALongSection) {
    SectionCodecSelector choice = measuredChoice();
    int sampled = 0;
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(choice.choose(1 << 20, 80), Coding::Zstd) << i;
        const size_t sample = choice.sampleBytes(1 << 20);
        EXPECT_TRUE(sample == 0 || sample == SectionCodecSelector::kLongBytes) << i;
        sampled += sample != 0;
    }
    EXPECT_EQ(sampled, 5) << "at 16, 32, 64, 128 and 256";
    EXPECT_EQ(choice.sampleBytes(1000), 0u);
}

TEST(SectionCodecSelector, ignoresTheFirstTimeAndOutliers) {
    SectionCodecSelector choice;
    choice.measured(Coding::Zstd, 1 << 16, 1 << 15, int64_t{1} << 30); // includes page faults
    for (const Coding coding : {Coding::Zstd, Coding::Lz4})
        for (int i = 0; i < 5; ++i)
            choice.measured(coding, 1 << 16, coding == Coding::Zstd ? 1 << 15 : 1 << 16, 3 << 16);
    EXPECT_EQ(choice.choose(1000, 32), Coding::Zstd);
    choice.measured(Coding::Zstd, 1 << 16, 1 << 15, 60 << 16);
    choice.measured(Coding::Zstd, 1 << 16, 1 << 15, 3 << 16);
    EXPECT_EQ(choice.choose(1000, 32), Coding::Zstd);
}

TEST(SectionCodecSelector, timesFewShortSectionsAndMoreLongOnes) {
    SectionCodecSelector choice = measuredChoice();
    const auto timedOf = [&](size_t sizeBytes) {
        int timed = 0;
        for (int i = 0; i < 1024; ++i) timed += choice.wantsTime(choice.choose(sizeBytes, 80), sizeBytes);
        return timed;
    };
    EXPECT_EQ(timedOf(1000), 64);
    EXPECT_EQ(timedOf(1 << 20), 256);
    EXPECT_TRUE(SectionCodecSelector().wantsTime(Coding::Zstd, 1 << 20));
    choice.measured(Coding::Zstd, 1000, 500, std::nullopt);
}

TEST(SectionCodecSelector, doesNotCompressShortSections) {
    SectionCodecSelector choice;
    EXPECT_EQ(choice.choose(0, 80), Coding::Empty);
    EXPECT_EQ(choice.choose(SectionCodecSelector::kMinBytes - 1, 80), Coding::Raw);
}

TEST(LinkRate, countsOnlyWritesThatWaited) {
    LinkRate rate;
    rate.wrote(1 << 20, 100'000); // into the system's buffer
    EXPECT_DOUBLE_EQ(rate.nsPerByte(), 32);
    for (int i = 0; i < 50; ++i) rate.wrote(1 << 20, 80 << 20);
    EXPECT_NEAR(rate.nsPerByte(), 80, 1);
}

} // namespace
} // namespace mural::delta
