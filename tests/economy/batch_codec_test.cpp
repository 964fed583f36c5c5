#include "tests/economy/both_sides.hpp"

namespace mural::economy::testing {
namespace {

TEST(SectionCodec, bothCodingsUseWhatCameBefore) {
    for (const Coding coding : {Coding::Lz4, Coding::Zstd}) { // of whose windows the smaller has 64 KiB
        SectionCompressor compressor;
        SectionDecompressor decompressor;
        std::mt19937 random(1);
        Bytes bytes(10'000);
        for (auto& b : bytes) b = static_cast<std::byte>(random());
        for (int round = 0; round < 6; ++round) {
            Bytes coded, back(bytes.size());
            ASSERT_TRUE(compressor.compress(coding, bytes, coded));
            EXPECT_LT(coded.size(), round > 0 ? 200u : 11'000u) << round;
            ASSERT_TRUE(decompressor.decompress(coding, coded, back));
            EXPECT_TRUE(back == bytes);
            bytes[static_cast<size_t>(round) * 300] ^= std::byte{1};
        }
        // Longer than windows and pieces.
        Bytes longer(3 << 20), coded, back(longer.size());
        for (size_t i = 0; i < longer.size(); ++i) longer[i] = static_cast<std::byte>(i * i >> 12);
        ASSERT_TRUE(compressor.compress(coding, longer, coded));
        ASSERT_TRUE(decompressor.decompress(coding, coded, back));
        EXPECT_TRUE(back == longer);
    }
}

TEST(SectionCodec, wrongSizesAreRefused) {
    for (const Coding coding : {Coding::Lz4, Coding::Zstd}) {
        const Bytes bytes(1000, std::byte{5});
        Bytes coded;
        ASSERT_TRUE(SectionCompressor().compress(coding, bytes, coded));
        for (const size_t size : {size_t{0}, size_t{999}, size_t{1001}, size_t{5000}}) {
            Bytes back(size);
            EXPECT_FALSE(SectionDecompressor().decompress(coding, coded, back)) << size;
        }
    }
}

TEST(BatchCodec, anyChangeIsAnErrorOrOtherBytes) {
    BatchEncoder encoder([] { return int64_t{0}; });
    const Bytes some(100, std::byte{1}), others(300, std::byte{2});
    const SectionBytes sections{some, others, {}, some};
    auto batch = encoder.encode(sections, 8);
    ASSERT_TRUE(batch.ok());
    const Bytes wire(batch->begin(), batch->end());
    for (size_t size = 0; size < wire.size(); ++size) EXPECT_FALSE(BatchDecoder().decode(std::span(wire).first(size)).ok()) << size;
    BatchDecoder decoder;
    auto back = decoder.decode(wire);
    ASSERT_TRUE(back.ok());
    for (size_t i = 0; i < kSections; ++i) EXPECT_TRUE(std::ranges::equal((*back)[i], sections[i]));
}

TEST(BatchCodec, sizesAreBounded) {
    // Control alone, raw, of 4 GiB; and compressed to 32 MiB and more.
    for (const uint32_t coding : {1u, 2u, 3u}) {
        ControlWriter head;
        head.number(UINT32_MAX);
        if (coding != 1) head.number(0);
        Bytes wire(1, static_cast<std::byte>(coding));
        wire.insert(wire.end(), head.bytes().begin(), head.bytes().end());
        EXPECT_FALSE(BatchDecoder().decode(wire).ok());
    }
}

} // namespace
} // namespace mural::economy::testing
