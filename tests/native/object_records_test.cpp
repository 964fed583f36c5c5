#include "streamcodec/wire/object_records.hpp"

#include <gtest/gtest.h>

#include "streamcodec/wire/record_walk.hpp"

namespace mural::wire {
namespace {

std::vector<std::byte> bytesOf(size_t count) {
    std::vector<std::byte> bytes(count);
    for (size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 31 + i / 256);
    return bytes;
}

std::vector<std::byte> recordsOf(std::span<const std::byte> message) {
    std::vector<std::byte> records;
    splitIntoRecords(message, [&](std::span<const std::byte> record) {
        records.insert(records.end(), record.begin(), record.end());
    });
    return records;
}

TEST(ObjectRecords, returnEveryMessage) {
    ObjectRecordJoiner joiner;
    for (const size_t size : {size_t{0}, size_t{1}, size_t{4}, size_t{37}, kObjectPieceBytes, kObjectPieceBytes + 1,
                              3 * kObjectPieceBytes + 5}) {
        const auto message = bytesOf(size);
        const auto records = recordsOf(message);
        RecordWalk walk(records);
        RecordView r;
        while (walk.next(r)) {
            ASSERT_EQ(r.opcode, kOpObject);
            ASSERT_TRUE(joiner.add(r.arguments));
        }
        ASSERT_TRUE(walk.whole());
        ASSERT_TRUE(joiner.isComplete()) << size;
        EXPECT_TRUE(std::ranges::equal(joiner.message(), message)) << size;
    }
}

TEST(ObjectRecords, refuseMalformedArguments) {
    ObjectRecordJoiner joiner;
    EXPECT_FALSE(joiner.add(bytesOf(4))); // no length
    const uint32_t tooLong[3] = {0, 5, 0};
    EXPECT_FALSE(joiner.add(std::as_bytes(std::span(tooLong))));
    const uint32_t tooMany[3] = {kMaxObjectBytes, 4, 0};
    EXPECT_FALSE(joiner.add(std::as_bytes(std::span(tooMany))));
    const uint32_t valid[3] = {0, 4, 7};
    EXPECT_TRUE(joiner.add(std::as_bytes(std::span(valid))));
    EXPECT_EQ(joiner.message().size(), 4u);
}

} // namespace
} // namespace mural::wire
