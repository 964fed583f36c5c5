// The codec selector with simulated links and contents: its choice is near the best one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compositor/selection/codec_selector.hpp"
#include "tests/compositor/test_planes.hpp"

namespace mural::compositor::test {
namespace {

// A measured codec: ns per byte to encode and to decode, and its ratio.
struct Model {
    double encodeNs, decodeNs, size;
};
// raw, bitplane, bitplane-zstd, lz4, zstd; for a picture with much background, and for a full one.
const std::vector<std::string> kNames = {"raw", "bitplane", "bitplane-zstd", "lz4", "zstd"};
const std::vector<Model> kSparse = {
    {0.15, 0.15, 1}, {0.12, 0.12, 0.02}, {0.2, 0.16, 0.012}, {0.3, 0.15, 0.03}, {0.6, 0.3, 0.02}};
const std::vector<Model> kDense = {
    {0.15, 0.15, 1}, {0.28, 0.22, 0.45}, {0.9, 0.5, 0.41}, {1.6, 0.3, 0.55}, {3.3, 0.9, 0.41}};
constexpr TileClass kClass{PlaneFormat::Rgba8, Activity::Flat, Change::Smooth};
constexpr uint64_t kPieceBytes = 65536;
constexpr double kGbit[] = {0.1, 1, 10, 25, 100};

double timeOf(const Model& m, double bytesPerSec, Overlap overlap) {
    const double transfer = m.size * 1e9 / bytesPerSec;
    const double ns =
        overlap == Overlap::Serial ? m.encodeNs + m.decodeNs + transfer : std::max({m.encodeNs, m.decodeNs, transfer});
    return ns * kPieceBytes;
}

class Simulation {
public:
    Simulation(Overlap overlap, double noise, unsigned seed = 1)
        : overlap_(overlap), noise_(noise), random_(seed), selector_(kNames, {.overlap = overlap}) {}

    // Returns the time relative to the best codec: 1.05 is 5 % more.
    double run(const std::vector<Model>& content, double bytesPerSec, int pieces) {
        double spent = 0, best = std::numeric_limits<double>::max();
        for (const Model& m : content) best = std::min(best, timeOf(m, bytesPerSec, overlap_) * pieces);
        for (int i = 0; i < pieces; ++i) {
            const CodecSelector::Choice choice = selector_.choose(kClass, kPieceBytes);
            const size_t c = choice.codec;
            const Model& m = content[c];
            const double hard = jitter(noise_); // some pieces are harder for all codecs
            const auto bytes = bytesOf(m, hard);
            spent += timeOf(m, bytesPerSec, overlap_);
            ++used_[c];
            selector_.encoded(kClass, c, kPieceBytes, bytes, nsOf(m.encodeNs));
            if (choice.measure) {
                const Model& other = content[*choice.measure];
                ++measured_[*choice.measure];
                spent += (other.encodeNs + other.decodeNs) * kPieceBytes; // not hidden by a transfer
                selector_.measured(kClass, *choice.measure, kPieceBytes, bytesOf(other, hard), nsOf(other.encodeNs),
                                   nsOf(other.decodeNs));
            }
            selector_.decoded(kClass, c, kPieceBytes, nsOf(m.decodeNs));
            selector_.transferred(
                bytes, static_cast<int64_t>(static_cast<double>(bytes) * 1e9 / bytesPerSec * jitter(noise_)));
        }
        return spent / best;
    }
    CodecSelector& selector() { return selector_; }
    [[nodiscard]] int measured(size_t codec) const { return measured_[codec]; }
    // How often each codec was used and measured.
    [[nodiscard]] std::string history() const {
        std::string text;
        for (size_t i = 0; i < kNames.size(); ++i)
            text += kNames[i] + " " + std::to_string(used_[i]) + "+" + std::to_string(measured_[i]) + "  ";
        return text;
    }

private:
    static uint64_t bytesOf(const Model& m, double hard) {
        return m.size >= 1 ? kPieceBytes : static_cast<uint64_t>(std::min(1.0, m.size * hard) * kPieceBytes);
    }
    int64_t nsOf(double nsPerByte) { return static_cast<int64_t>(nsPerByte * kPieceBytes * jitter(noise_)); }
    double jitter(double by) { return 1 + by * (static_cast<double>(random_() % 2001) / 1000 - 1); }
    Overlap overlap_;
    double noise_;
    std::array<int, 5> used_{}, measured_{};
    std::mt19937 random_;
    CodecSelector selector_;
};

TEST(CodecSelector, isNearTheBestOnEveryLink) {
    for (const Overlap overlap : {Overlap::Serial, Overlap::Pipelined})
        for (const bool dense : {false, true})
            for (const double gbit : kGbit)
                for (const double noise : {0.0, 0.2}) {
                    Simulation s(overlap, noise);
                    const double ratio = s.run(dense ? kDense : kSparse, gbit * 1e9 / 8, 2000); // 16 frames of 1080p
                    EXPECT_LT(ratio, 1.05) << gbit << " Gbit/s, dense " << dense << ": " << s.history();
                }
}

TEST(CodecSelector, followsContentAndLink) {
    for (const Overlap overlap : {Overlap::Serial, Overlap::Pipelined}) {
        Simulation s(overlap, 0.1);
        s.run(kSparse, 1e9 / 8, 1000);
        EXPECT_LT(s.run(kDense, 1e9 / 8, 1000), 1.1) << "other content";
        EXPECT_LT(s.run(kDense, 100e9 / 8, 1000), 1.1) << "a faster link";
        EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "raw");
        EXPECT_LT(s.run(kDense, 0.1e9 / 8, 1000), 1.1) << "a slower link";
        EXPECT_LT(s.run(kSparse, 10e9 / 8, 1000), 1.1) << "other content and another link at once: " << s.history();
    }
}

// Results for the old content say nothing about the new one.
TEST(CodecSelector, measuresAllCodecsAgainForNewContent) {
    const std::vector<Model> before = {
        {0.15, 0.15, 1}, {0.12, 0.12, 0.05}, {0.2, 0.16, 0.9}, {0.3, 0.15, 0.9}, {0.6, 0.3, 0.9}};
    std::vector<Model> after = before;
    after[1].size = 0.6;
    after[4].size = 0.05;
    Simulation s(Overlap::Pipelined, 0.1);
    s.run(before, 1e9 / 8, 1000);
    EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "bitplane");
    s.run(after, 1e9 / 8, 20);
    EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "zstd");
}

// If pieces grow with the current codec, they grow with the others: no old size counts.
TEST(CodecSelector, scalesOldSizesWithTheContent) {
    const std::vector<Model> before = {
        {0.15, 0.15, 1}, {0.2, 0.2, 0.02}, {0.2, 0.2, 0.03}, {0.2, 0.2, 0.04}, {0.2, 0.2, 0.05}};
    std::vector<Model> after = before;
    for (size_t i = 1; i < after.size(); ++i) after[i].size *= 10;
    Simulation s(Overlap::Serial, 0);
    s.run(before, 0.1e9 / 8, 1000);
    EXPECT_LT(s.run(after, 0.1e9 / 8, 6), 1.03) << s.history();
}

TEST(CodecSelector, switchesToRawForIncompressibleContent) {
    const std::vector<Model> noise = {
        {0.15, 0.15, 1}, {0.5, 0.2, 1.001}, {0.8, 0.3, 1.002}, {0.3, 0.15, 1.004}, {0.5, 0.2, 1.001}};
    for (const double gbit : kGbit) {
        Simulation s(Overlap::Serial, 0.1);
        EXPECT_LT(s.run(noise, gbit * 1e9 / 8, 2000), 1.05);
        EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "raw") << gbit;
    }
}

TEST(CodecSelector, separatesClasses) {
    CodecSelector selector(kNames);
    const TileClass depth{PlaneFormat::D24S8, Activity::Full, Change::Smooth};
    for (int i = 0; i < 400; ++i)
        for (const auto& [tile, content] : {std::pair{kClass, &kSparse}, {depth, &kDense}}) {
            const CodecSelector::Choice choice = selector.choose(tile, kPieceBytes);
            const size_t c = choice.codec;
            const Model& m = (*content)[c];
            if (choice.measure) {
                const Model& other = (*content)[*choice.measure];
                selector.measured(tile, *choice.measure, kPieceBytes, static_cast<uint64_t>(other.size * kPieceBytes),
                                  static_cast<int64_t>(other.encodeNs * kPieceBytes),
                                  static_cast<int64_t>(other.decodeNs * kPieceBytes));
            }
            selector.encoded(tile, c, kPieceBytes, static_cast<uint64_t>(m.size * kPieceBytes),
                             static_cast<int64_t>(m.encodeNs * kPieceBytes));
            selector.decoded(tile, c, kPieceBytes, static_cast<int64_t>(m.decodeNs * kPieceBytes));
            selector.transferred(kPieceBytes, kPieceBytes / 10); // 10 bytes per ns
        }
    EXPECT_EQ(selector.name(selector.best(kClass)), "bitplane");
    EXPECT_EQ(selector.name(selector.best(depth)), "raw");
    EXPECT_EQ(selector.name(selector.best({PlaneFormat::D32F, Activity::Full, Change::Sharp})), "raw")
        << "nothing is known";
    EXPECT_EQ(selector.expectedNsPerByte({PlaneFormat::D32F, Activity::Full, Change::Sharp}, 0), 0);
}

TEST(CodecSelector, isDeterministic) {
    Simulation a(Overlap::Pipelined, 0.3, 7), b(Overlap::Pipelined, 0.3, 7);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(a.run(kDense, 1e9, 50), b.run(kDense, 1e9, 50));
}

TEST(CodecSelector, measuresPossibleWinners) {
    Simulation s(Overlap::Pipelined, 0.1);
    s.run(kDense, 5e9 / 8, 4000);
    // bitplane is best here, bitplane-zstd is close, and zstd alone takes five times as long.
    EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "bitplane") << s.history();
    EXPECT_GT(s.measured(2), 4 * s.measured(4)) << s.history();
}

// On a fast link zstd would lose even with an empty output; on a slow one it may be the best.
TEST(CodecSelector, doesNotMeasureCodecsThatCannotWin) {
    for (const Overlap overlap : {Overlap::Serial, Overlap::Pipelined}) {
        Simulation s(overlap, 0.1);
        s.run(kDense, 100e9 / 8, 4000);
        EXPECT_LE(s.measured(4), 1) << s.history();
        std::vector<Model> other = kDense;
        other[4].size = 0.1;
        EXPECT_LT(s.run(other, 0.1e9 / 8, 2000), 1.1) << s.history();
        EXPECT_EQ(s.selector().name(s.selector().best(kClass)), "zstd");
    }
}

TEST(CodecSelector, ignoresOneInterruptedPiece) {
    CodecSelector selector({"raw", "bitplane"}, {.overlap = Overlap::Serial});
    for (int i = 0; i < 400; ++i) {
        const CodecSelector::Choice choice = selector.choose(kClass, kPieceBytes);
        const auto modelOf = [&](size_t codec) { return codec == 0 ? Model{0.15, 0.15, 1} : Model{0.12, 0.12, 0.3}; };
        const auto nsOf = [](double nsPerByte) { return static_cast<int64_t>(nsPerByte * kPieceBytes); };
        const Model m = modelOf(choice.codec);
        const double interrupted = i == 300 ? 50 : 1;
        selector.encoded(kClass, choice.codec, kPieceBytes, static_cast<uint64_t>(m.size * kPieceBytes),
                         nsOf(m.encodeNs * interrupted));
        if (choice.measure)
            selector.measured(kClass, *choice.measure, kPieceBytes,
                              static_cast<uint64_t>(modelOf(*choice.measure).size * kPieceBytes),
                              nsOf(modelOf(*choice.measure).encodeNs), nsOf(modelOf(*choice.measure).decodeNs));
        selector.decoded(kClass, choice.codec, kPieceBytes, nsOf(m.decodeNs));
        selector.transferred(kPieceBytes, kPieceBytes / 4); // 4 bytes per ns
        if (i >= 300) {
            EXPECT_EQ(selector.name(selector.best(kClass)), "bitplane") << i;
        }
    }
}

TEST(TileClass, classifiesContent) {
    std::mt19937 random(1);
    for (const PlaneFormat format : {PlaneFormat::Rgba8, PlaneFormat::D24S8, PlaneFormat::D32F}) {
        const auto classOf = [&](Content c) { return classify(makePlane(random, format, c, 256, 64).view()); };
        EXPECT_EQ(classOf(Content::Uniform).activity, Activity::Empty) << compositor::nameOf(format);
        EXPECT_EQ(classOf(Content::Rows).activity, Activity::Empty);
        EXPECT_LE(classOf(Content::Sparse).activity, Activity::Flat);
        EXPECT_EQ(classOf(Content::Noise), (TileClass{format, Activity::Full, Change::Sharp}));
        EXPECT_NE(classOf(Content::Surface).change, Change::Sharp); // 8 bits of a slope repeat
        // Rows of one value each, with large differences between rows.
        Plane striped(format, 256, 64);
        for (int32_t y = 0; y < 64; ++y)
            for (int32_t x = 0; x < 256; ++x) {
                const uint32_t word = static_cast<uint32_t>(y + 1) * 2654435761u;
                std::memcpy(striped.view().row(y) + 4 * x, &word, 4);
            }
        EXPECT_EQ(classify(striped.view()), (TileClass{format, Activity::Full, Change::Repeated}));
    }
    Plane tiny(PlaneFormat::Rgba8, 1, 1);
    EXPECT_EQ(classify(tiny.view()).activity, Activity::Full);
}

} // namespace
} // namespace mural::compositor::test
