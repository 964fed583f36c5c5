// Serialized batches and their compressed sections: round trips, size limits, damaged input.
#include "tests/delta/both_sides.hpp"

namespace mural::delta::testing {
namespace {

std::pair<BatchHead, Bytes> headAndBody(std::span<const std::byte> batch) {
    BatchHeadReader head;
    size_t at = 0;
    while (!head.add(batch[at++])) {}
    return {head.head(), Bytes(batch.begin() + static_cast<std::ptrdiff_t>(at), batch.end())};
}

Bytes randomBytes(size_t size, std::mt19937& random) {
    Bytes bytes(size);
    for (auto& b : bytes) b = static_cast<std::byte>(random());
    return bytes;
}

TEST(SectionCodec, usesEarlierSectionsWithBothCodings) {
    for (const Coding coding : {Coding::Lz4, Coding::Zstd}) { // the smaller window has 64 KiB
        SectionCompressor compressor;
        SectionDecompressor decompressor;
        std::mt19937 random(1);
        Bytes bytes = randomBytes(10'000, random);
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

// The window is moved in memory occasionally; its content stays available.
TEST(SectionCodec, keepsItsWindowOverSectionsOfAnySize) {
    for (const Coding coding : {Coding::Lz4, Coding::Zstd}) {
        SectionCompressor compressor;
        SectionDecompressor decompressor;
        std::mt19937 random(2);
        Bytes bytes = randomBytes(150'000, random);
        for (int section = 0; section < 400; ++section) {
            const size_t size = 1 + random() % (section % 20 == 0 ? bytes.size() : 30'000);
            const auto some = std::span(bytes).first(size);
            for (int time = 0; time < 2; ++time) {
                Bytes coded, back(size);
                ASSERT_TRUE(compressor.compress(coding, some, coded));
                ASSERT_TRUE(decompressor.decompress(coding, coded, back));
                ASSERT_TRUE(std::ranges::equal(back, some)) << section;
                const bool isInWindow = time > 0 && size < 60'000;
                ASSERT_LT(coded.size(), isInWindow ? size / 100 + 100 : size + size / 100 + 100)
                    << section << ", " << time;
            }
            bytes[random() % size] ^= std::byte{1};
        }
    }
}

TEST(SectionCodec, rejectsWrongSizes) {
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

TEST(BatchCodec, failsOrDiffersAfterAnyChange) {
    BatchEncoder encoder([](size_t) { return int64_t{0}; });
    const Bytes some(100, std::byte{1}), others(300, std::byte{2});
    const SectionBytes sections{some, others, {}, some, others};
    auto batch = encoder.encode(sections, 8);
    ASSERT_TRUE(batch.ok());
    const auto [head, body] = headAndBody(*batch);
    ASSERT_TRUE(head.sections);
    ASSERT_EQ(head.sizeBytes, body.size());
    // Control bytes are last: a cut there shortens them, a cut before is an error.
    for (size_t size = 0; size + some.size() < body.size(); ++size)
        EXPECT_FALSE(BatchDecoder().decode(head, std::span(body).first(size)).ok()) << size;
    BatchDecoder decoder;
    auto back = decoder.decode(head, body);
    ASSERT_TRUE(back.ok());
    for (size_t i = 0; i < kSections; ++i) EXPECT_TRUE(std::ranges::equal((*back)[i], sections[i]));
}

TEST(BatchCodec, addsOneByteToControlBytesAlone) {
    const Bytes some(60, std::byte{1});
    BatchEncoder encoder([](size_t) { return int64_t{0}; });
    auto batch = encoder.encode({some, {}, {}, {}, {}}, 8);
    ASSERT_TRUE(batch.ok());
    EXPECT_EQ(batch->size(), 61u);
    const auto [head, body] = headAndBody(*batch);
    EXPECT_FALSE(head.sections);
    BatchDecoder decoder;
    auto back = decoder.decode(head, body);
    ASSERT_TRUE(back.ok());
    EXPECT_TRUE(std::ranges::equal((*back)[0], some));
}

TEST(BatchHead, decodesByteByByte) {
    for (const uint32_t size : {0u, 1u, 63u, 64u, 8191u, 8192u, 1u << 20, 4u << 20, (1u << 27) - 1}) {
        Bytes bytes;
        putBatchHead({size, size % 3 == 0}, bytes);
        EXPECT_LE(bytes.size(), 4u);
        BatchHeadReader reader;
        for (size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(reader.add(bytes[i]), i + 1 == bytes.size()) << size;
        EXPECT_EQ(reader.head(), (BatchHead{size, size % 3 == 0}));
    }
    BatchHeadReader endless;
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(endless.add(std::byte{0x80}));
    EXPECT_TRUE(endless.add(std::byte{0x80}));
    EXPECT_GT(endless.head().sizeBytes, 1u << 30);
}

TEST(BatchCodec, limitsSizes) {
    // Words with 128 MiB, raw and compressed.
    for (const uint32_t coding : {1u, 2u, 3u}) {
        Bytes body{static_cast<std::byte>(coding), std::byte{0xff}, std::byte{0xff}, std::byte{0xff}, std::byte{0x3f}};
        if (coding != 1) body.push_back(std::byte{0});
        EXPECT_FALSE(BatchDecoder().decode({static_cast<uint32_t>(body.size()), true}, body).ok());
    }
}

} // namespace
} // namespace mural::delta::testing
