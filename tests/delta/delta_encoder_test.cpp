// The encoded size of typical changes from frame to frame.
#include <algorithm>
#include <utility>

#include "streamcodec/wire/record_walk.hpp"
#include "tests/delta/both_sides.hpp"

namespace mural::delta::testing {
namespace {

// A frame of many small records; the last one contains `frame`, like Swap.
Bytes frameOf(uint32_t frame, uint32_t records = 2000) {
    std::mt19937 random(7);
    Bytes bytes;
    for (uint32_t i = 0; i < records; ++i)
        addRecord(bytes, static_cast<uint16_t>(64 + random() % 200), 1 + random() % 6,
                  [&] { return static_cast<uint32_t>(random()); });
    addRecord(bytes, 8, 3, [&, window = true]() mutable { return std::exchange(window, false) ? 1 : frame; });
    return bytes;
}

Bytes textureOf(const Bytes& pixels) {
    Bytes bytes;
    for (size_t at = 0; at < pixels.size(); at += 65536) {
        const size_t size = std::min<size_t>(65536, pixels.size() - at);
        size_t word = 0;
        addRecord(bytes, 2, static_cast<uint32_t>(2 + size / 4), [&] {
            uint32_t value = static_cast<uint32_t>(size);
            if (word > 0) std::memcpy(&value, pixels.data() + at + (word - 1) * 4, 4);
            ++word;
            return value;
        });
    }
    return bytes;
}

Bytes noise(size_t size, uint32_t seed) {
    std::mt19937 random(seed);
    Bytes bytes(size);
    for (size_t i = 0; i + 4 <= size; i += 4) {
        const auto word = static_cast<uint32_t>(random());
        std::memcpy(bytes.data() + i, &word, 4);
    }
    return bytes;
}

// A frame's bytes as packets of at most one chunk, as programs send them.
std::vector<Packet> packetsOf(const Bytes& records, size_t pieceBytes = 3 * 65544) {
    std::vector<Packet> packets;
    for (size_t at = 0; at < records.size(); at += pieceBytes)
        packets.push_back(
            {0x10000, Bytes(records.begin() + static_cast<std::ptrdiff_t>(at),
                            records.begin() + static_cast<std::ptrdiff_t>(std::min(records.size(), at + pieceBytes)))});
    return packets;
}

TEST(DeltaEncoder, encodesARepeatedFrameInAFewBytes) {
    BothSides sides{Limits{}};
    const size_t first = sides.send(frameOf(1));
    EXPECT_GT(first, 10'000u);
    sides.send(frameOf(2));
    sides.send(frameOf(3)); // examines what the second frame skipped
    EXPECT_LE(sides.send(frameOf(4)), 24u);
    for (uint32_t frame = 5; frame < 50; ++frame) EXPECT_LE(sides.send(frameOf(frame)), 16u) << frame;
}

// For example display lists, which occur once.
TEST(DeltaEncoder, sendsManyNewRecordsAsBytesUntilTheyRepeat) {
    BothSides sides{Limits{}};
    const Bytes first = frameOf(1, 5000), second = frameOf(2, 5000);
    sides.send(first);
    EXPECT_GE(sides.staged, first.size());
    EXPECT_LE(sides.staged, first.size() + 800); // some hundred were examined
    const size_t again = sides.send(second);
    EXPECT_GE(sides.staged, second.size() / 2);
    EXPECT_LE(again, second.size() / 10); // the compressor has seen them
    sides.send(frameOf(3, 5000));
    EXPECT_LE(sides.send(frameOf(4, 5000)), 24u);
}

// In packets of a frame, each with a lower limit.
TEST(DeltaEncoder, recognisesNewRecordsOfSeveralPacketsWhenTheyRepeat) {
    BothSides sides{Limits{}};
    const Bytes all = frameOf(1, 9000);
    std::vector<Packet> packets;
    for (size_t at = 0, from = 0; at < all.size();) { // cut between records
        uint32_t head = 0;
        std::memcpy(&head, all.data() + at, 4);
        at += size_t{head >> 16} * 4;
        if (at - from < 30'000 && at < all.size()) continue;
        packets.push_back({0x10000, Bytes(all.begin() + static_cast<std::ptrdiff_t>(from),
                                          all.begin() + static_cast<std::ptrdiff_t>(at))});
        from = at;
    }
    ASSERT_GE(packets.size(), 4u);
    sides.send(packets);
    sides.send(packets);
    sides.send(packets);
    EXPECT_LE(sides.send(packets), 60u);
}

TEST(DeltaEncoder, encodesInsertedMissingAndMovedRecordsAtTheirSize) {
    BothSides sides{Limits{}};
    std::vector<Bytes> records;
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        Bytes record;
        addRecord(record, static_cast<uint16_t>(64 + i % 17), 6, [&] { return static_cast<uint32_t>(random()); });
        records.push_back(record);
    }
    const auto frame = [&] {
        Bytes bytes;
        for (const Bytes& r : records) bytes.insert(bytes.end(), r.begin(), r.end());
        return bytes;
    };
    sides.send(frame());
    sides.send(frame());
    Bytes inserted;
    addRecord(inserted, 64, 6, [&] { return static_cast<uint32_t>(random()); });
    records.insert(records.begin() + 100, inserted);
    EXPECT_LE(sides.send(frame()), 60u);
    records.erase(records.begin() + 500, records.begin() + 503);
    EXPECT_LE(sides.send(frame()), 30u);
    std::rotate(records.begin() + 200, records.begin() + 300, records.begin() + 800);
    EXPECT_LE(sides.send(frame()), 60u);
}

TEST(DeltaEncoder, sendsChangedWordsOnly) {
    BothSides sides{Limits{}};
    const auto frame = [](uint32_t moved) {
        Bytes bytes;
        for (uint32_t object = 0; object < 100; ++object)
            addRecord(bytes, 99, 18, [&, i = 0u]() mutable { return ++i == 13 ? moved * object : object + i; });
        return bytes;
    };
    sides.send(frame(1));
    const uint64_t before = sides.encoder.counts().patches;
    sides.send(frame(2));
    EXPECT_EQ(sides.encoder.counts().patches - before, 99u); // object 0 is unchanged
    EXPECT_LE(sides.staged, 99u * 6 + 12);
}

TEST(DeltaEncoder, encodesARepeatedTextureAtNoCost) {
    BothSides sides{Limits{}};
    const auto packets = packetsOf(textureOf(noise(8 << 20, 5)));
    EXPECT_GT(sides.send(packets), size_t{8} << 20);
    sides.send(packets);
    EXPECT_LE(sides.send(packets), 150u);
}

TEST(DeltaEncoder, encodesAPatchOfATextureAtItsSize) {
    BothSides sides{Limits{}};
    Bytes pixels = noise(8 << 20, 5); // 2048 × 1024
    sides.send(packetsOf(textureOf(pixels)));
    for (uint32_t frame = 0; frame < 4; ++frame) {
        const Bytes patch = noise(size_t{64} * 256, 100 + frame);
        for (size_t row = 0; row < 64; ++row)
            std::copy_n(patch.begin() + static_cast<std::ptrdiff_t>(row * 256), 256,
                        pixels.begin() + static_cast<std::ptrdiff_t>((row + 10 * frame) * 8192 + 1024));
        EXPECT_LE(sides.send(packetsOf(textureOf(pixels))), frame == 0 ? 22'000u : 17'500u) << frame;
    }
    EXPECT_LE(sides.send(packetsOf(textureOf(pixels))), 150u);
}

TEST(DeltaEncoder, refersToPagesOfOtherStreams) {
    BothSides sides{Limits{}};
    const Bytes texture = textureOf(noise(1 << 20, 9));
    for (const Packet& p : packetsOf(texture)) sides.send({p});
    size_t sum = 0;
    for (Packet p : packetsOf(texture)) {
        p.stream = 0x20003;
        sum += sides.send({p});
    }
    EXPECT_LE(sum, 400u);
}

// Flat colours consist of many equal pages, which must not cost one reference each.
TEST(DeltaEncoder, formsRunsOfEqualPages) {
    BothSides sides{Limits{}};
    Bytes pixels(4 << 20, std::byte{7});
    std::fill(pixels.begin() + (1 << 20), pixels.begin() + (1 << 20) + 9000, std::byte{9});
    const auto packets = packetsOf(textureOf(pixels));
    EXPECT_LE(sides.send(packets), 2000u);
    sides.send(packets);
    EXPECT_LE(sides.send(packets), 100u);
}

// One more of several equal records: the data equals the known run from its beginning, but not from its second record.
TEST(DeltaEncoder, comparesKnownRunsFromTheirMiddle) {
    BothSides sides{Limits{}};
    const auto frame = [](uint32_t first, int alike) {
        Bytes bytes;
        addRecord(bytes, 99, 4, [&] { return first; });
        for (int i = 1; i < 80; ++i) addRecord(bytes, 99, 4, [&] { return i < alike ? 7u : 8u; });
        return bytes;
    };
    for (int i = 0; i < 4; ++i) sides.send(frame(7, 40));
    sides.send(frame(9, 41));
    sides.send(frame(7, 40));
}

// Changed pages are found after short records that an earlier log contains.
TEST(DeltaEncoder, findsPagesWhileShortRecordsArePlain) {
    BothSides sides{Limits{}};
    Bytes pixels = noise(1 << 20, 3);
    const auto send = [&](uint32_t number) {
        for (size_t at = 512; at < pixels.size(); at += 4096) pixels[at] = static_cast<std::byte>(number);
        Bytes frame = frameOf(number, 300), texture = textureOf(pixels);
        frame.insert(frame.end(), texture.begin(), texture.end());
        return sides.send(packetsOf(frame));
    };
    for (uint32_t number = 0; number < 3; ++number) send(number);
    sides.encoder.beginFrame(true);
    send(3);
    EXPECT_LE(send(4), 6000u);
    EXPECT_LE(send(5), 6000u);
}

// Runs of equal size are sent as changes, including the second run of that size in a frame. If everything changes, the
// whole run is sent.
TEST(DeltaEncoder, sendsChangesOfPlainRunsOfOneSize) {
    BothSides sides{Limits{}};
    std::mt19937 random(7);
    const auto runOf = [&](size_t records) {
        Bytes run;
        for (size_t i = 0; i < records; ++i) addRecord(run, 99, 5, [&] { return static_cast<uint32_t>(random()); });
        return run;
    };
    std::vector<Packet> frame{
        {0x10000, runOf(300)}, {0x10000, runOf(300)}, {0x10001, runOf(300)}, {0x10000, runOf(500)}};
    const auto change = [&](size_t words) {
        for (Packet& packet : frame)
            for (size_t i = 0; i < words; ++i)
                packet.bytes[random() % (packet.bytes.size() / 20) * 20 + 8] ^= std::byte{1};
    };
    const auto send = [&] {
        sides.encoder.beginFrame(true);
        return sides.send(frame);
    };
    EXPECT_GE(send(), 20'000u);
    send();
    for (int i = 0; i < 20; ++i) {
        change(10);
        EXPECT_LE(send(), 900u) << i;
    }
    EXPECT_LE(send(), 60u) << "nothing has changed";
    for (int i = 0; i < 3; ++i) {
        for (Packet& packet : frame) packet.bytes = runOf(packet.bytes.size() / 20);
        EXPECT_GE(send(), 20'000u) << i;
    }
    for (int i = 0; i < 10; ++i) change(10), send();
    change(10);
    EXPECT_LE(send(), 900u) << "and is kept again";
    std::swap(frame[0], frame[3]);
    frame.pop_back();
    send(); // others in between, and fewer
    change(1);
    EXPECT_LE(send(), 200u);
}

// More runs than are stored.
TEST(DeltaEncoder, preservesPlainRunsOfManySizes) {
    BothSides sides{Limits{}};
    std::mt19937 random(8);
    Bytes all;
    for (int i = 0; i < 3000; ++i) addRecord(all, 99, 6, [&] { return static_cast<uint32_t>(random()); });
    for (int frame = 0; frame < 60; ++frame) {
        sides.encoder.beginFrame(true);
        std::vector<Packet> packets;
        for (int i = 0; i < 50; ++i) {
            const size_t records = 20 + random() % (frame % 2 == 0 ? 40 : 3000);
            packets.push_back({0x10000 + static_cast<uint32_t>(random() % 3),
                               {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(records * 24)}});
            all[random() % (all.size() / 24) * 24 + 4 + random() % 20] ^= std::byte{1};
        }
        sides.send(packets);
        if (::testing::Test::HasFailure()) break;
    }
}

// A frame of several batches: its omitted records repeat within it, which does not count as a repeated frame.
TEST(DeltaEncoder, countsALongFrameOnceForNewRecords) {
    const Bytes records = frameOf(1, 5000);
    BothSides whole{Limits{}}, frames{Limits{}};
    whole.goesOn = true;
    for (BothSides* each : {&whole, &frames})
        for (int i = 0; i < 4; ++i) each->send(records);
    EXPECT_GE(whole.staged, records.size() * 9 / 10); // as bytes
    EXPECT_LE(frames.staged, 1000u);
}

// The result of an earlier walk saves another one. An impossible result, as of a damaged packet, is ignored.
TEST(DeltaEncoder, preservesPlainRecordsWithAnyWalkResult) {
    Bytes packet;
    for (uint32_t i = 0; i < 50; ++i) addRecord(packet, 99, 3, [&] { return i; });
    const auto size = static_cast<uint32_t>(packet.size());
    for (const RecordOffsets& offsets :
         {RecordOffsets{50, 12, {}}, RecordOffsets{50, 1 << 20, {}}, RecordOffsets{50, 12, {size + 4096}},
          RecordOffsets{50, 12, {size - 12}}, RecordOffsets{50, 12, {0, 24, 60}}}) {
        BothSides sides(Limits{.cacheBytes = 1 << 20});
        sides.walked = &offsets;
        sides.encoder.beginFrame(true);
        for (int i = 0; i < 3; ++i) sides.send(packet);
        EXPECT_EQ(sides.encoder.counts().records, 150u);
        EXPECT_FALSE(sides.encoder.endsInValue());
    }
}

// Long records among them are found as without a walk result.
TEST(DeltaEncoder, findsLongRecordsAmongPlainOnesByTheWalkResult) {
    const Bytes pixels = noise(3 * kPageBytes, 21);
    const auto frame = [&](uint32_t number) {
        Bytes bytes = frameOf(number, 50), texture = textureOf(pixels), rest = frameOf(number, 30);
        bytes.insert(bytes.end(), texture.begin(), texture.end());
        bytes.insert(bytes.end(), rest.begin(), rest.end());
        return bytes;
    };
    RecordOffsets offsets{};
    wire::RecordView r;
    const Bytes first = frame(1);
    for (wire::RecordWalk walk(first); walk.next(r) || (offsets = *walk.whole(), false);) {}
    ASSERT_EQ(offsets.longAt.size(), 1u);
    BothSides withoutOffsets{Limits{}}, sides{Limits{}};
    sides.walked = &offsets;
    for (BothSides* each : {&withoutOffsets, &sides}) each->encoder.beginFrame(true);
    for (uint32_t number = 1; number < 6; ++number)
        EXPECT_EQ(sides.send(frame(number)), withoutOffsets.send(frame(number))) << number;
    EXPECT_EQ(sides.encoder.counts().pageHits, 4 * 3u);
    EXPECT_EQ(sides.encoder.counts().pageHits, withoutOffsets.encoder.counts().pageHits);
    EXPECT_EQ(sides.encoder.counts().records, withoutOffsets.encoder.counts().records);
}

// A part of the page changes in each frame, or in some of them. It keeps its slot, and the store keeps other pages.
TEST(DeltaEncoder, usesNoMemoryForAPageThatChangesConstantly) {
    for (const uint32_t framesAsItIs : {1u, 3u}) {
        Limits limits;
        limits.cacheBytes = 64 * kPageBytes;
        BothSides sides(limits);
        const Bytes other = textureOf(noise(40 * kPageBytes, 11));
        sides.send({{0x10000, other}});
        Bytes changing = noise(4 * kPageBytes, 12);
        for (uint32_t frame = 0; frame < 300; ++frame) {
            const uint32_t state = frame / framesAsItIs;
            std::memcpy(changing.data() + 2 * kPageBytes, &state, sizeof state);
            sides.send({{0x20000, textureOf(changing)}});
        }
        const uint64_t before = sides.encoder.counts().newPages;
        sides.send({{0x10000, other}});
        EXPECT_EQ(sides.encoder.counts().newPages, before) << framesAsItIs;
    }
}

// An earlier state that returns stays stored, however often the page changes.
TEST(DeltaEncoder, refersToReturningStatesOfAPage) {
    BothSides sides{Limits{}};
    const Bytes first = noise(4 * kPageBytes, 12);
    Bytes second = first;
    std::ranges::copy(noise(1000, 13), second.begin() + 5000);
    for (const uint32_t framesAsItIs : {1u, 3u})
        for (uint32_t frame = 0; frame < 60; ++frame) {
            const size_t wire = sides.send(packetsOf(textureOf(frame / framesAsItIs % 2 == 0 ? first : second)));
            if (frame > 4) {
                EXPECT_LE(wire, 16u) << framesAsItIs << ' ' << frame;
            }
        }
}

// While earlier states return, all of them stay stored, even if the previous record leads to the page.
TEST(DeltaEncoder, storesAnyNumberOfReturningStates) {
    for (const bool named : {false, true}) {
        BothSides sides{Limits{}};
        Bytes pixels = noise(4 * kPageBytes, 12), before;
        const auto send = [&](uint32_t number, const Bytes& state) {
            std::mt19937 name(number);
            Bytes bytes;
            const Bytes texture = textureOf(state);
            if (named) addRecord(bytes, 70, 40, [&] { return static_cast<uint32_t>(name()); });
            bytes.insert(bytes.end(), texture.begin(), texture.end());
            return sides.send(packetsOf(bytes));
        };
        send(0, pixels);
        for (uint32_t number = 1; number < 30; ++number) {
            before = pixels;
            std::ranges::copy(noise(1000, 100 + number), pixels.begin() + 5000);
            send(number, pixels);
            EXPECT_LE(send(number - 1, before), 20u) << named << ' ' << number;
            EXPECT_LE(send(number, pixels), 20u) << named << ' ' << number;
        }
    }
}

TEST(DeltaEncoder, keepsUsedPagesWhenTheCacheIsFull) {
    Limits limits;
    limits.cacheBytes = 4 << 20;
    BothSides sides{limits};
    const auto unchanged = packetsOf(textureOf(noise(1 << 20, 1)));
    sides.send(unchanged);
    for (uint32_t i = 0; i < 20; ++i) { // 20 MiB of unique data
        sides.send(packetsOf(textureOf(noise(1 << 20, 50 + i))));
        EXPECT_LE(sides.send(unchanged), 400u) << i;
    }
}

} // namespace
} // namespace mural::delta::testing
