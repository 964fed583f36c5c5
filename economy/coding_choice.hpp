// Which coding a section gets: the one by which its bytes are with the nodes soonest, by what was measured of this kind of
// section: time to compress, size afterwards, and how fast the link is. No clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "economy/section_codec.hpp"

namespace mural::economy {

class CodingChoice {
public:
    // Shorter ones go as they are: a compressor's own bytes cost more than it saves.
    static constexpr size_t kLeastBytes = 64;

    [[nodiscard]] Coding choose(size_t sizeBytes, double linkNsPerByte);
    // Of what was compressed to what it was before: by the better coding; 1 as long as nothing was.
    [[nodiscard]] double ratio() const;
    void measured(Coding coding, size_t sizeBytes, size_t codedBytes, int64_t ns);

private:
    struct Measured {
        double nsPerByte = 0;
        double ratio = 1; // of what it has made to what it was given
        uint64_t bytes = 0;
    };
    [[nodiscard]] double cost(Coding coding, double linkNsPerByte) const;
    std::array<Measured, kCodings> measured_{};
    uint64_t chosen_ = 0;
};

// How fast the link takes bytes, of writes that had to wait. As long as none has: a gigabit per second that four nodes share.
class LinkRate {
public:
    void wrote(size_t sizeBytes, int64_t ns);
    [[nodiscard]] double nsPerByte() const { return nsPerByte_; }

private:
    double nsPerByte_ = 32;
};

} // namespace mural::economy
