// Replies to a request from several nodes are combined into one.
#include "nodes/head/results/reply_assembler.hpp"
#include "streamcodec/wire/replies.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace mural {
namespace {

using wire::ReplyKind;
using wire::ReplyPartHeader;

ByteBuffer bytesOf(const std::vector<uint8_t>& values) {
    ByteBuffer buffer = ByteBuffer::ofSize(values.size());
    if (!values.empty()) std::memcpy(buffer.data(), values.data(), values.size());
    return buffer;
}

class AnswerAssemblerTest : public testing::Test {
protected:
    ReplyAssembler assembler{3,
                             [this](uint32_t client, Reply reply) { replies.emplace_back(client, std::move(reply)); }};
    std::vector<std::pair<uint32_t, Reply>> replies;

    bool rectangle(int node, int32_t x, int32_t w, uint8_t value, bool last = true, bool all = false) {
        ReplyPartHeader h{1, 5, static_cast<uint32_t>(ReplyKind::Rectangle), 2, x, 10, w, 1, all, last};
        return assembler.answer(node, h, bytesOf(std::vector<uint8_t>(static_cast<size_t>(w) * 2, value))).ok();
    }
    bool bytes(int node, const std::vector<uint8_t>& values, bool first, bool last = true) {
        ReplyPartHeader h{1, 6, static_cast<uint32_t>(ReplyKind::Bytes), 0, 0, 0, 0, 0, first, last};
        return assembler.answer(node, h, bytesOf(values)).ok();
    }
    std::vector<uint8_t> replyBytes() const {
        const auto span = replies.back().second.bytes.span();
        const auto* begin = reinterpret_cast<const uint8_t*>(span.data());
        return {begin, begin + span.size()};
    }
};

TEST_F(AnswerAssemblerTest, waitsForAnAddedNodeFromItsViewOn) {
    rectangle(0, 0, 1, 1);
    assembler.addNodes(1);
    assembler.nodeJoins(3, 1);
    rectangle(1, 1, 1, 2);
    assembler.nodeLost(3); // its absence does not matter to the open request
    rectangle(2, 2, 1, 3);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{1, 1, 2, 2, 3, 3}));
    assembler.nodeJoins(3, 2);
    for (int node = 0; node < 4; ++node) assembler.nodeInView(node, 2);
    for (int node = 0; node < 3; ++node) rectangle(node, node, 1, 4);
    EXPECT_EQ(assembler.missing(1), std::vector<int>{3});
    rectangle(3, 3, 1, 5);
    ASSERT_EQ(replies.size(), 2u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{4, 4, 4, 4, 4, 4, 5, 5}));
}

TEST_F(AnswerAssemblerTest, waitsForTheLastPartOfEveryNode) {
    rectangle(0, 0, 2, 1);
    rectangle(1, 2, 1, 2, false);
    rectangle(2, 4, 1, 4);
    EXPECT_TRUE(replies.empty());
    rectangle(1, 3, 1, 3);
    ASSERT_EQ(replies.size(), 1u);
    const wire::ReplyHeader& h = replies[0].second.header;
    EXPECT_EQ(replies[0].first, 1u);
    EXPECT_EQ(h.requestId, 5u);
    EXPECT_EQ(h.x, 0);
    EXPECT_EQ(h.y, 10);
    EXPECT_EQ(h.w, 5);
    EXPECT_EQ(h.h, 1);
    EXPECT_EQ(h.groupBytes, 2u);
    EXPECT_EQ(h.sizeBytes, 10u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{1, 1, 1, 1, 2, 2, 3, 3, 4, 4}));
    EXPECT_EQ(assembler.openRequests(), 0u);
}

TEST_F(AnswerAssemblerTest, deliversARectangleOfOneNodeWithoutWaiting) {
    rectangle(0, 0, 0, 0);
    EXPECT_TRUE(replies.empty());
    rectangle(2, 3, 2, 7, true, true);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replies[0].second.header.x, 3);
    EXPECT_EQ(replies[0].second.header.w, 2);
    EXPECT_EQ(replies[0].second.header.failed, 0u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{7, 7, 7, 7}));
    EXPECT_EQ(assembler.openRequests(), 1u); // later answers are discarded
    rectangle(1, 0, 0, 0);
    EXPECT_EQ(replies.size(), 1u);
    EXPECT_EQ(assembler.openRequests(), 0u);
}

TEST_F(AnswerAssemblerTest, deliversARectangleOfOneNodeWhenAnotherIsLost) {
    rectangle(2, 3, 2, 7, true, true);
    assembler.nodeLost(0);
    assembler.nodeLost(1);
    EXPECT_EQ(replies.size(), 1u);
    EXPECT_EQ(assembler.openRequests(), 0u);
}

TEST_F(AnswerAssemblerTest, fillsHolesWithZeros) {
    rectangle(0, 0, 1, 7);
    rectangle(2, 3, 1, 9);
    assembler.nodeLost(1);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{7, 7, 0, 0, 0, 0, 9, 9}));
    EXPECT_EQ(replies[0].second.header.failed, 0u);
}

TEST_F(AnswerAssemblerTest, acceptsARectangleOutsideAllTiles) {
    for (int node = 0; node < 3; ++node) rectangle(node, 0, 0, 0);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replies[0].second.header.failed, 0u);
    EXPECT_EQ(replies[0].second.header.sizeBytes, 0u);
}

TEST_F(AnswerAssemblerTest, takesBytesFromOneNode) {
    bytes(2, {}, false);
    bytes(1, {9}, false);
    EXPECT_TRUE(replies.empty());
    bytes(0, {1, 2}, true, false);
    bytes(0, {3}, true);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{1, 2, 3}));
    EXPECT_EQ(assembler.openRequests(), 0u);
}

// Undefined bytes differ between nodes: two reads must return the same node's.
TEST_F(AnswerAssemblerTest, takesBytesFromTheFirstLivingNodeWhicheverIsFastest) {
    bytes(2, {7}, true);
    bytes(1, {5}, true);
    EXPECT_TRUE(replies.empty());
    bytes(0, {3}, true);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{3}));
}

TEST_F(AnswerAssemblerTest, deliversBytesWithoutWaitingForOthers) {
    bytes(0, {1}, true);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(assembler.openRequests(), 1u);
    bytes(1, {2}, false);
    bytes(2, {2}, false);
    EXPECT_EQ(replies.size(), 1u) << "once per request";
    EXPECT_EQ(assembler.openRequests(), 0u);
}

TEST_F(AnswerAssemblerTest, takesBytesFromAnotherNodeAfterALoss) {
    bytes(0, {1}, true, false); // half of it
    bytes(2, {7}, false);
    bytes(1, {5, 6}, false);
    assembler.nodeLost(0);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replyBytes(), (std::vector<uint8_t>{5, 6}));
    EXPECT_EQ(replies[0].second.header.failed, 0u);
}

TEST_F(AnswerAssemblerTest, failsOnlyWithoutAnyAnswer) {
    bytes(0, {1}, true, false);
    bytes(1, {}, false);
    bytes(2, {}, false);
    assembler.nodeLost(0);
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_EQ(replies[0].second.header.failed, 1u);
    EXPECT_EQ(replies[0].second.header.sizeBytes, 0u);
}

TEST_F(AnswerAssemblerTest, addsSums) {
    for (int node = 0; node < 3; ++node) {
        ReplyPartHeader h{1, 7, static_cast<uint32_t>(ReplyKind::Sum), 0, 0, 0, 0, 0, 0, 1};
        std::vector<uint8_t> value(8, 0);
        value[4] = 1; // 2^32
        value[0] = 200;
        ASSERT_TRUE(assembler.answer(node, h, bytesOf(value)).ok());
    }
    ASSERT_EQ(replies.size(), 1u);
    uint64_t sum = 0;
    std::memcpy(&sum, replyBytes().data(), 8);
    EXPECT_EQ(sum, 3 * ((uint64_t{1} << 32) + 200));
}

TEST_F(AnswerAssemblerTest, reportsContradictions) {
    EXPECT_TRUE(rectangle(0, 0, 1, 1));
    EXPECT_FALSE(rectangle(0, 0, 1, 1)) << "after its last";
    ReplyPartHeader other{1, 5, static_cast<uint32_t>(ReplyKind::Bytes), 0, 0, 0, 0, 0, 0, 1};
    EXPECT_FALSE(assembler.answer(1, other, {}).ok());
    ReplyPartHeader unknown{1, 8, 77, 0, 0, 0, 0, 0, 0, 1};
    EXPECT_FALSE(assembler.answer(1, unknown, {}).ok());
    ReplyPartHeader far{1, 5, static_cast<uint32_t>(ReplyKind::Rectangle), 2, 1 << 20, 1 << 20, 1, 1, 0, 1};
    EXPECT_FALSE(assembler.answer(1, far, bytesOf({1, 2})).ok()) << "a union beyond all memory";
}

} // namespace
} // namespace mural
