// Frames with equal commands.
#include "nodes/head/capture/frame_comparer.hpp"

#include <gtest/gtest.h>
#include <vector>

#include "streamcodec/wire/control_records.hpp"

namespace mural {
namespace {

std::vector<std::byte> commands(uint32_t word, size_t count = 20) {
    const std::vector<uint32_t> words(count, word);
    const auto bytes = std::as_bytes(std::span(words));
    return {bytes.begin(), bytes.end()};
}
std::vector<std::byte> withSwap(std::vector<std::byte> bytes, uint32_t window, uint32_t frame) {
    const uint32_t swap[] = {wire::kOpSwap | 3U << 16, window, frame};
    const auto more = std::as_bytes(std::span(swap));
    bytes.insert(bytes.end(), more.begin(), more.end());
    return bytes;
}

TEST(FrameComparer, findsRepeatedFrames) {
    FrameComparer frames(7);
    EXPECT_FALSE(frames.published(1, withSwap(commands(1), 1, 1))->isRepeated) << "the first one";
    const auto second = frames.published(1, withSwap(commands(1), 1, 2));
    ASSERT_TRUE(second);
    EXPECT_TRUE(second->isRepeated) << "the number of the frame does not count";
    EXPECT_EQ(second->client, 7u);
    EXPECT_EQ(second->frame, 2u);
    EXPECT_FALSE(frames.published(1, withSwap(commands(2), 1, 3))->isRepeated);
    EXPECT_FALSE(frames.published(1, withSwap(commands(1), 1, 4))->isRepeated);
    EXPECT_TRUE(frames.published(1, withSwap(commands(1), 1, 5))->isRepeated);
}

TEST(FrameComparer, ignoresTheSizesOfPublications) {
    FrameComparer frames(1);
    (void)frames.published(1, withSwap(commands(1, 20), 1, 1));
    EXPECT_FALSE(frames.published(1, commands(1, 5)));
    EXPECT_FALSE(frames.published(1, commands(1, 11)));
    EXPECT_TRUE(frames.published(1, withSwap(commands(1, 4), 1, 2))->isRepeated);
    EXPECT_FALSE(frames.published(1, withSwap(commands(1, 19), 1, 3))->isRepeated) << "one command less";
}

TEST(FrameComparer, comparesFramesOfOneWindow) {
    FrameComparer frames(1);
    (void)frames.published(1, withSwap(commands(1), 1, 1));
    (void)frames.published(1, withSwap(commands(2), 2, 2));
    EXPECT_TRUE(frames.published(1, withSwap(commands(1), 1, 3))->isRepeated);
    EXPECT_FALSE(frames.published(1, withSwap(commands(3), 2, 4))->isRepeated);
}

TEST(FrameComparer, includesCommandsOfOtherThreads) {
    FrameComparer frames(1);
    (void)frames.published(1, withSwap(commands(1), 1, 1));
    (void)frames.published(2, commands(9));
    EXPECT_FALSE(frames.published(1, withSwap(commands(1), 1, 2))->isRepeated);
    EXPECT_TRUE(frames.published(1, withSwap(commands(1), 1, 3)).has_value());
}

} // namespace
} // namespace mural
