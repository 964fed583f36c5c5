#include <gtest/gtest.h>

#include "common/base/clock.hpp"
#include "nodes/render/windows/overlay_part.hpp"

namespace mural {
namespace {

NodeSetup setupOfNode(int node, OverlayMode mode) {
    NodeSetup setup;
    setup.node = node;
    setup.overlay = mode;
    return setup;
}

bool takes(OverlayPart& part, const std::vector<uint32_t>& modes) { return part.take(std::as_bytes(std::span(modes))); }

TEST(OverlayPart, takesTheModeOfItsNode) {
    OverlayPart part(setupOfNode(1, OverlayMode::Names));
    EXPECT_EQ(part.overlay()->mode(), OverlayMode::Names);
    EXPECT_EQ(part.overlay()->content().role, "node 1");
    EXPECT_FALSE(part.overlay()->content().host.empty());
    EXPECT_TRUE(takes(part, {0, 3, 0}));
    EXPECT_EQ(part.overlay()->mode(), OverlayMode::Grid);
}

TEST(OverlayPart, refusesInvalidModes) {
    OverlayPart part(setupOfNode(1, OverlayMode::Names));
    EXPECT_FALSE(takes(part, {0, 4}));
    EXPECT_TRUE(takes(part, {3})); // sent before the node existed
    EXPECT_EQ(part.overlay()->mode(), OverlayMode::Names);
}

TEST(OverlayPart, showsTheNumbersOfItsFrames) {
    OverlayPart part(setupOfNode(0, OverlayMode::Stats));
    ASSERT_EQ(part.overlay()->content().nodes.size(), 1U);
    EXPECT_TRUE(part.overlay()->content().nodes[0].frames.frames().empty());
    const int64_t beganNs = monotonicNowNs();
    uint32_t frame = 0;
    while (part.overlay()->content().nodes[0].frames.frames().empty() && monotonicNowNs() - beganNs < 20 * kNsPerS) {
        const wire::FrameSpansHeader header{1, 1, ++frame, 0, int64_t{frame} * 1'000'000};
        const std::vector<wire::FrameSpan> spans = {{static_cast<uint32_t>(SpanKind::Replay), 0, 0, 4'000'000}};
        part.frameSpans(std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(spans)));
    }
    const FrameHistory history = part.overlay()->content().nodes[0].frames;
    ASSERT_FALSE(history.frames().empty());
    EXPECT_EQ(history.frames().back().frame, frame);
    EXPECT_DOUBLE_EQ(history.meanMs(FramePart::Replay), 4);
}

} // namespace
} // namespace mural
