#include <gtest/gtest.h>

#include <random>

#include "objects/wire/message_parts.hpp"
#include "objects/wire/messages.hpp"

namespace mural::objects {
namespace {

const std::vector<std::byte> kSomeBytes = {std::byte{1}, std::byte{2}, std::byte{3}};

std::vector<Message> examples() {
    const BlobName name{std::byte{5}, std::byte{6}};
    return {
        ShareMessage{7, Uuid{std::byte{1}}, Sharing::Instance, Delivery::OnDemand, 3, 4, 64, 0x123456789, "camera",
                     "Camera", "int32; text"},
        CommitMessage{7, 300, 299, 0x8000000000000001, {{kSomeBytes, {}}, {{}, {}}}},
        CommitMessage{7, 1, 0, 1, {{kSomeBytes, {{name, 1000}}}}},
        OfferMessage{9, 12},
        UnshareMessage{9},
        BlobBeginMessage{{name, uint64_t{1} << 40}},
        BlobDataMessage{name, 262144, PieceCoding::Raw, 0, 0, kSomeBytes},
        BlobDataMessage{name, 262144, PieceCoding::ZstdPlanes, 1000, 7, kSomeBytes},
        BlobAtMessage{{name, 65536, 4711, 12, 99}},
        RefuseMessage{Refusal::UnknownBlob, 0, 0, name},
        CatalogueEndMessage{12},
        WantMessage{3, 4, 2},
        WantBlobMessage{name, 5, 1 << 20, false, 125'000'000},
        TokenMessage{3, 5},
        AskMessage{1, 16},
        ItemMessage{1, 44, 7, kSomeBytes},
        DoneMessage{1, 44},
        ClosedMessage{1},
        EnterMessage{2, 17, 5000},
        GoMessage{2, 17, 4},
        LateMessage{2, 17, "left, right"},
        PartMessage{true, kSomeBytes},
    };
}

std::vector<std::byte> bytesOf(const Message& message) {
    const auto buffer = encode(message);
    return {buffer.bytes().begin(), buffer.bytes().end()};
}

TEST(Messages, restoreTheirContents) {
    for (const Message& message : examples()) {
        const auto bytes = bytesOf(message);
        const auto decoded = decode(bytes);
        ASSERT_TRUE(decoded) << message.index();
        EXPECT_EQ(decoded->index(), message.index());
        EXPECT_EQ(bytesOf(*decoded), bytes) << message.index();
    }
}

TEST(Messages, keepACommitOfOneNumberSmall) {
    const std::vector<std::byte> number(8);
    for (const uint64_t slots : {uint64_t{1}, uint64_t{1} << 36, uint64_t{1} << 63}) {
        const Message message = CommitMessage{1000, 1'000'000, 999'999, slots, {{number, {}}}};
        EXPECT_LE(bytesOf(message).size(), 40U);
    }
}

TEST(Messages, rejectEveryTruncation) {
    for (const Message& message : examples()) {
        const auto bytes = bytesOf(message);
        if (std::holds_alternative<BlobDataMessage>(message) || std::holds_alternative<ItemMessage>(message) ||
            std::holds_alternative<PartMessage>(message))
            continue;
        for (size_t length = 0; length < bytes.size(); ++length)
            EXPECT_FALSE(decode(std::span(bytes).first(length))) << message.index() << ' ' << length;
    }
}

TEST(Messages, rejectValuesOutOfRange) {
    ShareMessage share{1, {}, Sharing::Delta, Delivery::Push, 0, 0, 65, 0, "", "", ""};
    EXPECT_FALSE(decode(bytesOf(share)));
    share.slotCount = 0;
    EXPECT_FALSE(decode(bytesOf(share)));
    EXPECT_FALSE(decode(bytesOf(CommitMessage{1, 0, 0, 0, {}})));
    EXPECT_FALSE(decode(std::vector<std::byte>{std::byte{0}}));
    EXPECT_FALSE(decode(std::vector<std::byte>{std::byte{200}, std::byte{1}}));
}

TEST(MessageParts, restoreLargeMessages) {
    std::vector<std::byte> large(1000);
    for (size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::byte>(i);
    for (const size_t limit : {64U, 999U, 1000U, 5000U}) {
        MessageJoiner joiner;
        std::vector<std::vector<std::byte>> joined;
        const auto pass = [&](std::span<const std::byte> part) {
            EXPECT_LE(part.size(), limit);
            const auto whole = joiner.input(part);
            ASSERT_TRUE(whole);
            if (whole.value()) joined.emplace_back(whole.value()->begin(), whole.value()->end());
        };
        cutMessage(large, limit, pass);
        cutMessage(kSomeBytes, limit, pass);
        cutMessage(large, limit, pass);
        EXPECT_EQ(joined, (std::vector{large, kSomeBytes, large})) << limit;
    }
}

TEST(MessageParts, rejectMessagesBetweenParts) {
    MessageJoiner joiner;
    const auto part = bytesOf(PartMessage{false, kSomeBytes});
    EXPECT_TRUE(joiner.input(part));
    EXPECT_FALSE(joiner.input(bytesOf(UnshareMessage{1})));
    EXPECT_TRUE(joiner.input(bytesOf(UnshareMessage{1}))) << "the damaged message is dropped";
    EXPECT_FALSE(joiner.input(std::vector{std::byte{20}}));
}

TEST(Messages, surviveRandomDamage) {
    std::mt19937_64 random(1);
    const auto messages = examples();
    for (int i = 0; i < 20'000; ++i) {
        auto bytes = bytesOf(messages[random() % messages.size()]);
        for (size_t n = 1 + random() % 4; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        if (const auto decoded = decode(bytes)) {
            const auto again = bytesOf(*decoded);
            EXPECT_TRUE(decode(again).has_value());
        }
    }
}

} // namespace
} // namespace mural::objects
