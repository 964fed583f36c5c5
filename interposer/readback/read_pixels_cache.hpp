// A cache of pixels that the nodes have sent and that no command has changed since. Without it, a program that reads
// pixel by pixel would need a round trip each time. The second small read at one position of the stream fetches a
// block.
#pragma once

#include <GL/gl.h>
#include <cstddef>
#include <cstdint>

namespace mural {

struct ThreadState;

class ReadPixelsCache {
public:
    struct Kind {
        GLenum format, type;
        uint32_t groupBytes;
        uint32_t how; // flags of streamcodec/wire/control_records.hpp
        bool operator==(const Kind&) const = default;
    };
    struct Box {
        GLint x, y;
        GLsizei w, h;
    };

    // Copies the box from the cache to `into`, tightly packed. Returns false if it is not cached.
    bool find(const ThreadState& t, const Kind& kind, const Box& box, void* into) const;
    // Returns the box to request instead. It is larger if the previous request directly precedes this one in the
    // stream.
    Box wider(const ThreadState& t, const Kind& kind, const Box& box) const;
    // Returns whether this read continues a series of small reads, which justifies fetching a block.
    bool inSeries(const ThreadState& t, const Kind& kind, const Box& box);
    // Memory for the reply to a larger request; null if the allocation fails.
    std::byte* memory(size_t sizeBytes);
    // Records an answered request. `stored`: its pixels are in memory().
    void answered(const ThreadState& t, const Kind& kind, const Box& box, bool stored);

private:
    [[nodiscard]] bool nothingSince(const ThreadState& t, const Kind& kind) const;

    const std::byte* cursor_ = nullptr; // stream position after the request
    uint32_t publications_ = 0;
    uint32_t context_ = 0;
    Kind kind_{};
    Box box_{};
    bool valid_ = false;
    uint32_t series_ = 0;
    std::byte* bytes_ = nullptr;
    size_t capacityBytes_ = 0;
};

} // namespace mural
