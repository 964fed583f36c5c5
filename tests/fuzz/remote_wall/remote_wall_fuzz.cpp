// Feeds a sequence of arbitrary messages, each with a source, to both ends of a remote wall. A parsed message survives
// a further encoding. The assembly keeps few frames, and its frames can be decoded or are rejected with one line.
#include <string>
#include <variant>

#include "nodes/remote_wall/frame_assembly.hpp"
#include "nodes/remote_wall/send_window.hpp"
#include "nodes/remote_wall/tile_canvas.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {
namespace {

using namespace remote;

constexpr uint32_t kFuzzSources = 2;
constexpr int64_t kMostPixels = 1 << 18; // larger pictures only take time

void mustBeOneLine(const std::string& text) {
    must(!text.empty() && text.find('\n') == std::string::npos, "an error is one line");
}

class Ends {
public:
    uint64_t take(uint32_t source, const Message& message) {
        return std::visit([&](const auto& m) { return takeOne(source, m); }, message);
    }

private:
    uint64_t takeOne(uint32_t source, const Tile& tile) {
        if (tile.size.pixels() > kMostPixels) return 0;
        return judge(assembly_.add(source, tile));
    }
    uint64_t takeOne(uint32_t source, const FrameEnd& end) {
        if (end.size.pixels() > kMostPixels) return 0;
        const uint64_t count = judge(assembly_.end(source, end));
        must(assembly_.incomplete() <= FrameAssembly::kMaxIncomplete, "few frames are incomplete");
        (void)assembly_.takeLoss();
        uint64_t last = 0;
        for (const CompleteFrame& frame : assembly_.takeComplete()) {
            must(frame.number > last, "frames are in order");
            last = frame.number;
            if (judge(canvas_.apply(frame)) > 0) must(canvas_.size() == frame.size, "the canvas has the frame's size");
        }
        return count;
    }
    uint64_t takeOne(uint32_t, const Ack& ack) {
        if (window_.hasRoom()) {
            const auto nowNs = static_cast<int64_t>(++sent_);
            window_.sent(sent_, 1, nowNs, nowNs);
        }
        return window_.acknowledge(ack.frame, 1) ? 1 : 0;
    }
    uint64_t takeOne(uint32_t, const Want& want) {
        window_.limitRate(want.rate);
        must(window_.nextNs() >= 0, "times do not overflow");
        return 1;
    }
    uint64_t takeOne(uint32_t, const Event& event) {
        must(event.input.x >= 0 && event.input.x <= 1 && event.input.y >= 0 && event.input.y <= 1,
             "places are fractions");
        must(event.input.button >= 1 && event.input.button <= 9, "buttons are 1 to 9");
        return 1;
    }
    uint64_t takeOne(uint32_t, const Hello& hello) {
        must(hello.version != kWallVersion || hello.source < hello.sources, "a source is one of all");
        return 1;
    }
    uint64_t takeOne(uint32_t, const Bye& bye) {
        must(bye.reason.find('\n') == std::string::npos, "a reason is one line");
        return 1;
    }
    static uint64_t judge(const Result<void>& done) {
        if (!done) mustBeOneLine(done.error().message);
        return done ? 1 : 0;
    }

    FrameAssembly assembly_{kFuzzSources};
    TileCanvas canvas_{"auto"};
    SendWindow window_{60};
    uint64_t sent_ = 0;
};

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    InputReader in(input);
    Ends ends;
    uint64_t count = 0;
    while (!in.empty()) {
        const uint32_t source = in.byte() % kFuzzSources;
        const std::vector<std::byte> bytes = in.piece();
        const auto message = parseMessage(bytes);
        if (!message) {
            mustBeOneLine(message.error().message);
            continue;
        }
        const std::vector<std::byte> again = encode(*message);
        const auto second = parseMessage(again);
        must(second && encode(*second) == again, "a message survives a further encoding");
        count += ends.take(source, *message);
    }
    return count;
}

} // namespace mural::fuzz
