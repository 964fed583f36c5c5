// Decoded data equals encoded data: random streams, with dictionaries so small that entries are replaced constantly.
#include <bit>
#include <cmath>

#include "tests/delta/both_sides.hpp"
#include "tests/sanitized.hpp"

namespace mural::delta::testing {
namespace {

// Frames similar to a program's: records of a small set, some changed, moved or omitted, some long, some malformed.
class RandomProgram {
public:
    explicit RandomProgram(uint32_t seed) : random_(seed) {
        for (int i = 0; i < 60; ++i) records_.push_back(record());
    }

    Bytes frame() {
        for (uint32_t n = below(6); n > 0; --n) change();
        Bytes bytes;
        const uint32_t from = below(4) ? 0 : below(records_.size());
        for (size_t i = from; i < records_.size(); ++i)
            if (below(40)) bytes.insert(bytes.end(), records_[i].begin(), records_[i].end());
        if (below(10) == 0) odd(bytes);
        return bytes;
    }
    uint32_t below(size_t n) { return static_cast<uint32_t>(random_() % n); }

private:
    Bytes record() {
        Bytes bytes;
        uint32_t words = 1 + below(8);
        if (below(12) == 0) words = 1 + below(400);
        if (below(20) == 0) words = 1 + below(20'000);
        if (below(200) == 0) words = 0xffff + below(3);
        const uint32_t kind = below(3), same = static_cast<uint32_t>(random_());
        addRecord(bytes, static_cast<uint16_t>(64 + below(9)), words, [&] {
            return kind == 0 ? static_cast<uint32_t>(random_()) : kind == 1 ? same : below(3);
        });
        return bytes;
    }
    void change() {
        Bytes& r = records_[below(records_.size())];
        switch (below(5)) {
        case 0: r = record(); break;
        case 1: records_.insert(records_.begin() + below(records_.size()), record()); break;
        case 2: records_.erase(records_.begin() + below(records_.size())); break;
        case 3: std::rotate(records_.begin(), records_.begin() + below(records_.size()), records_.end()); break;
        default:
            for (uint32_t n = 1 + below(20); n > 0 && r.size() > 8; --n)
                r[8 + below(r.size() - 8)] = static_cast<std::byte>(below(256));
        }
    }
    void odd(Bytes& bytes) {
        switch (below(3)) {
        // truncated within a record
        case 0: bytes.resize(bytes.size() - std::min<size_t>(bytes.size(), below(9))); break;
        case 1:
            bytes.insert(bytes.end(), 1 + below(30), std::byte{0});
            break; // a record without length
        // an invalid length
        default: bytes.insert(bytes.begin(), {std::byte{64}, std::byte{0}, std::byte{0xff}, std::byte{0xff}});
        }
    }

    std::mt19937 random_;
    std::vector<Bytes> records_;
};

void compare(const Limits& limits, uint32_t seed, uint32_t streams, int frames) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    BothSides sides(limits);
    std::vector<RandomProgram> programs;
    for (uint32_t i = 0; i < streams; ++i) programs.emplace_back(seed * 100 + i);
    std::mt19937 random(seed);
    for (int frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame) {
        std::vector<Packet> packets;
        for (uint32_t n = 1 + random() % 3; n > 0; --n) {
            const auto stream = static_cast<uint32_t>(random() % streams);
            Bytes bytes = programs[stream].frame();
            bytes.resize(std::min<size_t>(bytes.size(), 1 << 20));
            // Cuts anywhere, like publications; here even within records.
            const size_t cut = random() % (bytes.size() + 1);
            packets.push_back({stream, Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut))});
            packets.push_back({stream, Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(cut), bytes.end())});
        }
        if (frame % 8 == 0) sides.encoder.beginFrame(random() % 3 == 0);
        sides.send(packets);
    }
}

TEST(Identity, holdsWithLargeDictionaries) {
    for (uint32_t seed = 1; seed <= 4; ++seed)
        compare(Limits{.cacheBytes = 64 << 20, .textBytes = 1 << 20, .logItems = 1 << 16, .streams = 8}, seed, 3, 60);
}

TEST(Identity, holdsWithTinyDictionaries) {
    // at least five seeds, one for each number of streams
    for (uint32_t seed = 1; seed <= mural::testing::rounds(40); ++seed) compare(tinyLimits(), seed, 1 + seed % 5, 60);
}

TEST(Identity, holdsWithLogsOfOneItemAndOnePage) {
    for (uint32_t seed = 1; seed <= 6; ++seed)
        compare({.cacheBytes = kPageBytes, .textBytes = 4096, .logItems = 1, .streams = 1}, seed, 2, 60);
}

// Smooth motion is predicted from more shared state than jumps.
TEST(Identity, holdsForSmoothMotion) {
    for (const Limits& limits : {Limits{.cacheBytes = 1 << 20}, tinyLimits()}) {
        BothSides sides{limits};
        std::mt19937 random(5);
        double time = 0, sum = 0;
        for (int frame = 0; frame < 300 && !::testing::Test::HasFailure(); ++frame) {
            time += 0.01 + 0.003 * static_cast<double>(random() % 1000) / 1000;
            Bytes bytes;
            for (uint32_t object = 0; object < 12; ++object) {
                if (random() % 30 == 0) continue;
                addRecord(bytes, 99, 20, [&, word = 0u]() mutable {
                    const double angle = time * (1 + object % 3);
                    const uint32_t i = word++;
                    const auto value = static_cast<float>(i % 2 == 0   ? (1 + i) * std::cos(angle)
                                                          : i % 3 == 0 ? 1.0 + object
                                                                       : (2 + i) * std::sin(angle));
                    return std::bit_cast<uint32_t>(value);
                });
            }
            const size_t size = sides.send(bytes);
            if (frame >= 100) sum += static_cast<double>(size);
        }
        if (limits.modelWords > 2000) {
            EXPECT_LE(sum / 200, 12 * 16 * 4 * 0.4) << "without a guess 768";
        }
    }
}

TEST(Identity, holdsForEmptyPackets) {
    BothSides sides{tinyLimits()};
    sides.send(std::vector<Packet>{{0, {}}, {0xffffffff, {}}, {0, {}}});
    sides.send(std::vector<Packet>{});
}

} // namespace
} // namespace mural::delta::testing
