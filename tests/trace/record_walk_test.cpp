// Records skipped together equal those visited one by one: numbers per command, positions, totals.
#include "streamcodec/wire/record_walk.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/record_rounds.hpp"

namespace mural::trace {
namespace {

struct Passed {
    std::map<uint16_t, size_t> opcodes; // number per opcode
    std::vector<size_t> examined;       // offsets of the opcodes in kExamined
    size_t at = 0;
    RecordOffsets walked;
};

constexpr uint16_t kExamined = 99;

std::vector<std::byte> someRecords(std::mt19937& random) {
    std::vector<std::byte> packet =
        mural::testing::recordRounds(random, [](auto& p) { mural::testing::putRecord(p, kExamined, 2); });
    const auto below = [&](uint32_t n) { return random() % n; };
    if (below(4) == 0) mural::testing::putRecord(packet, 1, 0); // an invalid record
    // truncates the last one
    if (below(4) == 0 && packet.size() > 4) packet.resize(packet.size() - 4 * (1 + below(2)) + 2);
    return packet;
}

// Walks up to a record of kExamined after maxExamined of them.
Passed byOne(std::span<const std::byte> packet, size_t maxExamined = 0) {
    Passed p;
    size_t at = 0;
    while (packet.size() - at >= 4) {
        uint32_t head = 0;
        std::memcpy(&head, packet.data() + at, sizeof head);
        const size_t sizeBytes = (head >> 16) * size_t{4};
        if (sizeBytes == 0 || sizeBytes > packet.size() - at) break;
        if (static_cast<uint16_t>(head) == kExamined) {
            if (p.examined.size() == maxExamined) break;
            p.examined.push_back(at);
        }
        ++p.opcodes[static_cast<uint16_t>(head)];
        p.walked.pass(at, sizeBytes);
        at += sizeBytes;
    }
    p.at = at;
    return p;
}

void expectPassed(const wire::RecordWalk& walk, const Passed& right) {
    ASSERT_EQ(walk.at(), right.at);
    const RecordOffsets* const whole = walk.whole();
    if (whole == nullptr) return;
    EXPECT_EQ(whole->records, right.walked.records);
    EXPECT_EQ(whole->lastBytes, right.walked.lastBytes);
    EXPECT_EQ(whole->longAt, right.walked.longAt);
}

template <typename Each> void forRandomPackets(const Each& each) {
    for (uint32_t seed = 0; seed < 3000 && !::testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        each(someRecords(random), random);
    }
}

TEST(RecordWalk, skipsRoundsLikeSingleRecords) {
    size_t passed = 0;
    forRandomPackets([&](std::span<const std::byte> packet, std::mt19937&) {
        const Passed right = byOne(packet);
        std::map<uint16_t, size_t> opcodes;
        wire::RecordWalk walk(packet);
        walk.skip([&](uint16_t opcode, size_t times) {
            if (opcode == kExamined) return false;
            opcodes[opcode] += times;
            passed += times;
            return true;
        });
        ASSERT_EQ(opcodes, right.opcodes);
        expectPassed(walk, right);
    });
    EXPECT_GT(passed, 100'000u);
}

TEST(RecordWalk, reportsSelectedRecords) {
    size_t examinedRecords = 0;
    forRandomPackets([&](std::span<const std::byte> packet, std::mt19937& random) {
        const size_t maximum = random() % 8;
        const Passed right = byOne(packet, maximum);
        std::vector<size_t> examined;
        wire::RecordWalk walk(packet);
        walk.pass(
            [](uint16_t opcode) {
                return opcode == kExamined ? wire::RecordWalk::Interest::Examine : wire::RecordWalk::Interest::None;
            },
            [&](const wire::RecordView& r) {
                if (examined.size() == maximum) return false;
                EXPECT_EQ(r.opcode, kExamined);
                EXPECT_EQ(r.arguments.size(), r.sizeBytes - 4);
                examined.push_back(r.offset);
                return true;
            });
        examinedRecords += examined.size();
        ASSERT_EQ(examined, right.examined);
        expectPassed(walk, right);
    });
    EXPECT_GT(examinedRecords, 1000u);
}

// From any position in a round: triangles with a normal, quads with a colour per corner, polygons.
TEST(RecordWalk, skipsRoundsWithRepeatedCommands) {
    for (const std::string round : {"eff", "nmomomomop", "nbvvvve", "aabab", "abcdefghijklmnop"})
        for (size_t from = 0; from < round.size(); ++from) {
            SCOPED_TRACE(round + " from " + std::to_string(from));
            std::vector<std::byte> packet;
            for (size_t i = 0; i < 1000 * round.size(); ++i) {
                const char command = round[(from + i) % round.size()];
                mural::testing::putRecord(packet, static_cast<uint32_t>(command),
                                          1 + static_cast<uint32_t>(command % 3));
            }
            size_t examinedCount = 0, passed = 0;
            wire::RecordWalk walk(packet);
            walk.skip([&](uint16_t, size_t times) {
                ++examinedCount;
                passed += times;
                return true;
            });
            EXPECT_EQ(passed, 1000 * round.size());
            EXPECT_LE(examinedCount, 20 + 8 * round.size());
        }
}

} // namespace
} // namespace mural::trace
