#include "tests/fuzz/replay_harness.hpp"

#include <cstring>

#include "streamcodec/wire/head_messages.hpp"
#include "streamcodec/wire/packet.hpp"
#include "streamcodec/wire/replies.hpp"
#include "common/log/process_log.hpp"
#include "tests/fuzz/fake_gl.hpp"

namespace mural::fuzz {

namespace {

// Returns limits small enough for many runs per second; the code that enforces them is the same.
PlayerConfig configOf(uint8_t options) {
    PlayerConfig c;
    if (options & kTiles) {
        c.grid = {2, 2, options & kLean ? 2 : 1};
        c.region = {1, 1, 1, 1};
    }
    c.lean = options & kLean;
    c.limits = {.blobBytes = 1 << 20, .answerBytes = 1 << 16, .listCommands = 1 << 10};
    return c;
}

void touch(std::span<const std::byte> bytes) {
    volatile uint8_t sum = 0;
    for (const std::byte b : bytes) sum = static_cast<uint8_t>(sum + static_cast<uint8_t>(b));
}

PlayerOutputs outputs() {
    PlayerOutputs out;
    out.answer = [](const wire::ReplyPartHeader&, std::span<const std::byte> bytes) { touch(bytes); };
    out.frameDone = [](const PlayerOutputs::Frame& f) {
        // The node reads its region; a small part is sufficient here and saves time.
        const PixelViewport r = intersect(f.region, {f.region.x, f.region.y, 16, 16});
        if (f.pixels) touch({f.pixels(r), static_cast<size_t>(r.area()) * 4});
    };
    log::setLevels(log::parseLevels("off").value()); // random streams cause a line per record
    return out;
}

} // namespace

PlayerCounts replayBytes(std::span<const std::byte> input) {
    if (input.empty()) return {};
    const auto options = static_cast<uint8_t>(input[0]);
    Replay replay(makeFakePlatform({.colorBuffers = (options & kSingleBuffered) != 0 ? gl::ColorBuffers::OneNamedFront
                                                                                     : gl::ColorBuffers::FrontAndBack,
                                    .surfacesFail = (options & kSurfacesFail) != 0}),
                  configOf(options), outputs());
    input = input.subspan(1);
    while (input.size() > sizeof(wire::PacketHeader)) {
        wire::PacketHeader header{};
        std::memcpy(&header, input.data(), sizeof header);
        input = input.subspan(sizeof header);
        const size_t bytes = std::min<size_t>(header.sizeBytes, input.size());
        // A copy of exactly this size: a sanitizer detects the first byte read beyond it.
        const auto payload = std::make_unique<std::byte[]>(bytes);
        std::memcpy(payload.get(), input.data(), bytes);
        input = input.subspan(bytes);
        uint32_t words[2] = {};
        std::memcpy(words, payload.get(), std::min(bytes, sizeof words));
        if (wire::clientOf(header.stream) != 0)
            (void)replay.packet(header.stream, {payload.get(), bytes});
        else if (words[0] == static_cast<uint32_t>(wire::HeadCommand::ClientGone))
            replay.clientGone(words[1]);
    }
    return replay.counts();
}

} // namespace mural::fuzz
