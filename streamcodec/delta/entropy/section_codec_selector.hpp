// Selects the coding of each section by minimal delivery time, from measurements of this section kind: compression
// time, compressed size, and link rate. Has no clock of its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "streamcodec/delta/entropy/section_codec.hpp"

namespace mural::delta {

class SectionCodecSelector {
public:
    // Shorter sections stay uncompressed: a compressor's overhead exceeds its gain.
    static constexpr size_t kMinBytes = 64;
    static constexpr size_t kLongBytes = 16384; // the cost of reading a clock is negligible from this size on

    [[nodiscard]] Coding choose(size_t sizeBytes, double linkNsPerByte);
    // Returns the number of bytes of the last section to compress with LZ4 too, as a measurement; 0: no measurement. A
    // measurement of all of a long section, such as the first pictures of a program, would increase its cost by half.
    [[nodiscard]] size_t sampleBytes(size_t sizeBytes) const {
        return sizeBytes >= kLongBytes && known(Coding::Zstd) && (!known(Coding::Lz4) || triesAgain()) ? kLongBytes : 0;
    }
    // Returns true if the last section should be timed. Reading a thread's CPU clock takes as long as compressing a
    // short section.
    [[nodiscard]] bool wantsTime(Coding coding, size_t sizeBytes) const;
    // Returns the compression ratio of the better coding; 1 before the first measurement.
    [[nodiscard]] double ratio() const;
    // Reports a result. `ns`: empty if it was not timed.
    void measured(Coding coding, size_t sizeBytes, size_t codedBytes, std::optional<int64_t> ns);

private:
    struct Measured {
        double nsPerByte = 0;
        double ratio = 1; // compressed size by original size
        uint64_t bytes = 0, sections = 0, times = 0;
    };
    [[nodiscard]] bool known(Coding coding) const;
    [[nodiscard]] Coding best(double linkNsPerByte) const;
    [[nodiscard]] bool triesAgain() const; // a trial of the coding that is not chosen is due
    [[nodiscard]] double ratioOf(Coding coding) const { return measured_[static_cast<size_t>(coding)].ratio; }
    [[nodiscard]] double cost(Coding coding, double linkNsPerByte) const;
    std::array<Measured, kCodings> measured_{};
    uint64_t chosen_ = 0;
    size_t tries_ = 0; // trials before a choice exists
};

// Rate at which the link accepts bytes, from writes that had to wait. Initially one gigabit per second shared by four
// nodes.
class LinkRate {
public:
    void wrote(size_t sizeBytes, int64_t ns);
    [[nodiscard]] double nsPerByte() const { return nsPerByte_; }

private:
    double nsPerByte_ = 32;
};

} // namespace mural::delta
