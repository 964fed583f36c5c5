// Which coding a section gets: the one by which its bytes are with the nodes soonest, by what was measured of this kind of
// section: time to compress, size afterwards, and how fast the link is. No clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "economy/section_codec.hpp"

namespace mural::economy {

class CodingChoice {
public:
    // Shorter ones go as they are: a compressor's own bytes cost more than it saves.
    static constexpr size_t kLeastBytes = 64;
    static constexpr size_t kLongBytes = 16384; // beside which a clock costs nothing

    [[nodiscard]] Coding choose(size_t sizeBytes, double linkNsPerByte);
    // LZ4 shall be measured on so many bytes of the section that was chosen for last, which goes otherwise: to try it on all of a long one, such as
    // the first pictures that a program loads, would make that half again as large. 0: not.
    [[nodiscard]] size_t sampleBytes(size_t sizeBytes) const { return sizeBytes >= kLongBytes && known(Coding::Zstd) && (!known(Coding::Lz4) || triesAgain()) ? kLongBytes : 0; }
    // Of the section that was chosen for last: reading a thread's clock takes as long as to compress a short one.
    [[nodiscard]] bool wantsTime(Coding coding, size_t sizeBytes) const;
    // Of what was compressed to what it was before: by the better coding; 1 as long as nothing was.
    [[nodiscard]] double ratio() const;
    // `ns`: none where nobody has measured it.
    void measured(Coding coding, size_t sizeBytes, size_t codedBytes, std::optional<int64_t> ns);

private:
    struct Measured {
        double nsPerByte = 0;
        double ratio = 1; // of what it has made to what it was given
        uint64_t bytes = 0, sections = 0, times = 0;
    };
    [[nodiscard]] bool known(Coding coding) const;
    [[nodiscard]] Coding best(double linkNsPerByte) const;
    [[nodiscard]] bool triesAgain() const; // the one that was not chosen
    [[nodiscard]] double ratioOf(Coding coding) const { return measured_[static_cast<size_t>(coding)].ratio; }
    [[nodiscard]] double cost(Coding coding, double linkNsPerByte) const;
    std::array<Measured, kCodings> measured_{};
    uint64_t chosen_ = 0;
    size_t tries_ = 0; // where none was chosen
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
