// Maps swap records to frames of the wall, as the head counts them for --out and --frames.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "common/base/main_window.hpp"
#include "streamcodec/wire/record_walk.hpp"
#include "streamcodec/wire/control_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural::trace {

class WallFrames {
public:
    // Returns the number of the frame that the record ends; 0: none.
    int64_t record(uint32_t stream, const wire::RecordView& r) {
        const uint32_t client = wire::clientOf(stream), window = wire::argumentWord(r, 0);
        switch (r.opcode) {
        case wire::kOpWindow:
            windows_[{client, window}] = {wire::argumentWord(r, 1), wire::argumentWord(r, 2),
                                          uint64_t{wire::argumentWord(r, 7)} << 32 | wire::argumentWord(r, 6)};
            return 0;
        case wire::kOpDestroyWindow:
            windows_.erase({client, window});
            mainWindow_.windowGone(client, window);
            return 0;
        case wire::kOpSwap:
        case wire::kOpFrontPicture: break;
        default: return 0;
        }
        if (wire::argumentWord(r, 1) == wire::kUnseenFrame) return 0;
        const auto found = windows_.find({client, window});
        const Window at = found == windows_.end() ? Window{} : found->second;
        const int64_t frame = mainWindow_.swapped(client, window, at.width, at.height, at.native);
        if (frame > 0) frames_ = frame;
        return frame;
    }
    // Processes all records of a packet; returns the number of frames that it ends.
    uint32_t packet(uint32_t stream, std::span<const std::byte> payload) {
        wire::RecordWalk walk(payload);
        wire::RecordView r;
        uint32_t ended = 0;
        while (walk.next(r)) ended += record(stream, r) > 0;
        return ended;
    }
    void clientGone(uint32_t client) {
        mainWindow_.clientGone(client);
        std::erase_if(windows_, [client](const auto& entry) { return entry.first.first == client; });
    }
    [[nodiscard]] int64_t frames() const { return frames_; } // complete frames

private:
    struct Window {
        uint32_t width = 0, height = 0;
        uint64_t native = 0;
    };
    std::map<std::pair<uint32_t, uint32_t>, Window> windows_; // by client and window
    MainWindow mainWindow_;
    int64_t frames_ = 0;
};

} // namespace mural::trace
