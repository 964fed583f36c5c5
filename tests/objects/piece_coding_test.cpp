// Compression of blobs on request: the coding alone, and its choice between a writer and a reader on a simulated link.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "objects/blob/piece_coding.hpp"
#include "objects/core/object_master.hpp"
#include "objects/core/object_mirror.hpp"
#include "tests/objects/recording_sink.hpp"

namespace mural::objects::test {
namespace {

using Bytes = std::vector<std::byte>;

// Coordinates of a curve, whose high bytes change slowly.
Bytes curve(size_t floats) {
    Bytes bytes(4 * floats);
    for (size_t i = 0; i < floats; ++i) {
        const float value = 10.f * std::sin(static_cast<float>(i) * .0001f);
        std::memcpy(bytes.data() + 4 * i, &value, 4);
    }
    return bytes;
}

Bytes noise(size_t count) {
    Bytes bytes(count);
    std::mt19937 random(7);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    return bytes;
}

// A clock that advances by 1 ms per reading, so a piece of 256 KiB takes 3.8 ns per byte.
int64_t slowClock() {
    static int64_t now = 0;
    return now += 1'000'000;
}

constexpr uint64_t kSlow = 10'000'000, kFast = 1'000'000'000; // bytes per second

TEST(PieceCoding, restoresEveryPiece) {
    Bytes scratch;
    for (const size_t rest : {0U, 1U, 3U}) {
        const Bytes whole = curve(30'000);
        const std::span<const std::byte> raw = std::span(whole).first(whole.size() - rest);
        PieceCoder coder(slowClock);
        const CodedPiece piece = coder.code(blobNameOf(raw), raw, kSlow);
        EXPECT_EQ(piece.coding, PieceCoding::ZstdPlanes) << "better than the words for coordinates";
        EXPECT_LT(piece.bytes.size(), raw.size() * 3 / 4);
        EXPECT_EQ(piece.codingMicroseconds, 1000U);
        const auto decoded = decodePiece(piece.coding, piece.bytes, raw.size(), scratch);
        ASSERT_TRUE(decoded);
        EXPECT_TRUE(std::ranges::equal(*decoded, raw));
    }
    const Bytes text(100'000, std::byte{'a'});
    PieceCoder coder(slowClock);
    const CodedPiece piece = coder.code(blobNameOf(text), text, kSlow);
    ASSERT_NE(piece.coding, PieceCoding::Raw);
    EXPECT_TRUE(std::ranges::equal(*decodePiece(piece.coding, piece.bytes, text.size(), scratch), text));
}

TEST(PieceCoding, staysRawWhereCodingSavesNoTime) {
    const Bytes raw = curve(60'000);
    PieceCoder coder(slowClock);
    const auto codingAt = [&](uint64_t rate) { return coder.code(blobNameOf(raw), raw, rate).coding; };
    EXPECT_EQ(codingAt(0), PieceCoding::Raw) << "the rate is unknown";
    EXPECT_EQ(codingAt(kSlow), PieceCoding::ZstdPlanes);
    EXPECT_EQ(codingAt(kFast), PieceCoding::Raw) << "the link is faster than the coding";
    const Bytes random = noise(200'000);
    EXPECT_EQ(coder.code(blobNameOf(random), random, kSlow).coding, PieceCoding::Raw);
    const Bytes small = curve(500);
    EXPECT_EQ(coder.code(blobNameOf(small), small, kSlow).coding, PieceCoding::Raw);
}

TEST(PieceCoding, rejectsDamagedPieces) {
    const Bytes raw = curve(30'000);
    PieceCoder coder(slowClock);
    const CodedPiece piece = coder.code(blobNameOf(raw), raw, kSlow);
    Bytes scratch, coded(piece.bytes.begin(), piece.bytes.end());
    EXPECT_FALSE(decodePiece(piece.coding, coded, raw.size() - 4, scratch));
    EXPECT_FALSE(decodePiece(piece.coding, coded, raw.size() + 4, scratch));
    EXPECT_FALSE(decodePiece(piece.coding, std::span(coded).first(coded.size() / 2), raw.size(), scratch));
    EXPECT_FALSE(decodePiece(PieceCoding::Raw, coded, raw.size(), scratch));
    EXPECT_FALSE(decodePiece(PieceCoding::Zstd, {}, raw.size(), scratch));
    coded[0] ^= std::byte{0xff};
    EXPECT_FALSE(decodePiece(piece.coding, coded, raw.size(), scratch));
}

// A reader requests a blob of an object over a link of a rate. `damages` changes the bytes of a piece, by its number.
class Link {
public:
    explicit Link(uint64_t bytesPerSecond) : rate_(bytesPerSecond) {}

    // Returns whether the blob arrived.
    bool transfer(const Bytes& bytes, size_t damagedPiece = SIZE_MAX) {
        RecordingSink toReader, toWriter;
        ObjectMaster master(toReader, {.gatherNs = 0});
        ObjectDescription description{Uuid{std::byte{1}}, {.delivery = Delivery::OnDemand}, {}};
        description.layout.fieldCount = 1;
        const ObjectNumber number = master.share(description).value();
        const Bytes value(1);
        const Blob blob = Blob::copyOf(bytes).value();
        EXPECT_TRUE(master.commit(number, {1, {{value, std::span(&blob, 1)}}}));
        ObjectMirror mirror(toWriter);
        size_t pieces = 0;
        for (int step = 0; step < 2000; ++step) {
            for (const auto& sent : toReader.take()) {
                now_ += static_cast<int64_t>(1e9 * static_cast<double>(sent.bytes.size()) / static_cast<double>(rate_));
                Message message = *decode(sent.bytes);
                if (auto* const data = std::get_if<BlobDataMessage>(&message)) {
                    received_ += data->bytes.size();
                    codings_.push_back(data->coding);
                    if (pieces++ == damagedPiece) data->bytes = data->bytes.first(data->bytes.size() / 2);
                }
                if (!mirror.input(message, now_)) ++errors_;
            }
            mirror.want({Uuid{std::byte{1}}, 0}, now_);
            const auto found = mirror.find({Uuid{std::byte{1}}, 0});
            if (found.presence == ObjectMirror::Presence::Here) {
                EXPECT_EQ(found.state->slots[0]->blobs[0]->blob, blob);
                return true;
            }
            const auto requests = toWriter.take();
            if (requests.empty()) now_ += 200'000'000; // nothing happens until a request is repeated
            for (const auto& sent : requests) (void)master.input(1, sent.bytes, now_);
            mirror.tick(now_);
            master.tick(now_);
        }
        return false;
    }
    [[nodiscard]] uint64_t received() const { return received_; }
    [[nodiscard]] int errors() const { return errors_; }
    [[nodiscard]] size_t coded() const {
        return codings_.size() - static_cast<size_t>(std::ranges::count(codings_, PieceCoding::Raw));
    }

private:
    uint64_t rate_;
    int64_t now_ = 1'000'000'000;
    uint64_t received_ = 0;
    int errors_ = 0;
    std::vector<PieceCoding> codings_;
};

constexpr size_t kFloats = 4U << 20; // 16 MiB

TEST(RequestedBlobs, areCodedOnASlowLink) {
    Link link(kSlow);
    ASSERT_TRUE(link.transfer(curve(kFloats)));
    EXPECT_LT(link.received(), 4 * kFloats * 3 / 4) << "from the second window on";
    EXPECT_GT(link.coded(), 40U);
}

TEST(RequestedBlobs, stayRawOnAFastLink) {
    Link link(20 * kFast);
    ASSERT_TRUE(link.transfer(curve(kFloats)));
    EXPECT_EQ(link.coded(), 0U);
    EXPECT_EQ(link.received(), 4 * kFloats);
}

TEST(RequestedBlobs, repeatADamagedPiece) {
    Link link(kSlow);
    ASSERT_TRUE(link.transfer(curve(kFloats), 20));
    EXPECT_EQ(link.errors(), 1);
}

} // namespace
} // namespace mural::objects::test
