// Pixels that the nodes have told and that nothing has changed since. A program that reads pixel by pixel would
// otherwise wait for a round trip each time: the second small read at the same place of the stream fetches a block.
#pragma once

#include <GL/gl.h>
#include <cstddef>
#include <cstdint>

namespace mural {

struct ThreadState;

class KeptPixels {
public:
    struct Kind {
        GLenum format, type;
        uint32_t groupBytes;
        uint32_t how; // flags of wire.hpp
        bool operator==(const Kind&) const = default;
    };
    struct Box {
        GLint x, y;
        GLsizei w, h;
    };

    // The box out of what is kept, tightly packed at `into`. False: it is not there.
    bool find(const ThreadState& t, const Kind& kind, const Box& box, void* into) const;
    // What to ask for in place of a box: more than it, when the last question stands right before in the stream.
    Box wider(const ThreadState& t, const Kind& kind, const Box& box) const;
    // One more small read with nothing between them, after many: better a block than one by one.
    bool inSeries(const ThreadState& t, const Kind& kind, const Box& box);
    // Memory for the answer to a wider question; null: there is none.
    std::byte* memory(size_t sizeBytes);
    // A question has been answered; `kept`: its pixels are in memory().
    void answered(const ThreadState& t, const Kind& kind, const Box& box, bool kept);

private:
    [[nodiscard]] bool nothingSince(const ThreadState& t, const Kind& kind) const;

    const std::byte* cursor_ = nullptr; // of the stream, behind the question
    uint32_t publications_ = 0;
    uint32_t context_ = 0;
    Kind kind_{};
    Box box_{};
    bool holds_ = false;
    uint32_t series_ = 0;
    std::byte* bytes_ = nullptr;
    size_t capacityBytes_ = 0;
};

} // namespace mural
