// The parts of the latest frames of a node, for the overlay `stats`. Pure; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string_view>

#include "nodes/frame_spans/thread_spans.hpp"

namespace mural {

// In the order of a bar, from below.
enum class FramePart : size_t { Decode, Replay, Readback, Compose, Compress, Transfer, Assemble, Present, Wait };

inline constexpr std::array<std::string_view, 9> kFramePartNames = {
    "decode", "replay", "readback", "compose", "compress", "transfer", "assemble", "present", "wait"};
inline constexpr size_t kFrameParts = kFramePartNames.size();
static_assert(kFrameParts == static_cast<size_t>(FramePart::Wait) + 1);

struct FrameParts {
    uint32_t frame = 0;
    int64_t endNs = 0; // 0: unknown
    std::array<double, kFrameParts> ms{};

    [[nodiscard]] double totalMs() const;
};

// Adds the spans of one thread. countsWaits: its waits are a part of the frame, as those of the replay thread are.
// Other threads wait for that one.
void addParts(FrameParts& parts, std::span<const Span> spans, bool countsWaits);

class FrameHistory {
public:
    static constexpr size_t kFrames = 60;

    // Drops the oldest frame if there are kFrames.
    void add(const FrameParts& frame);
    [[nodiscard]] const std::deque<FrameParts>& frames() const { return frames_; }
    [[nodiscard]] double framesPerSecond() const; // 0: unknown
    [[nodiscard]] double meanMs(FramePart part) const;

private:
    std::deque<FrameParts> frames_;
};

} // namespace mural
