// In front of each batch: how many bytes follow, and whether there is more among them than control bytes. A number in sevens of
// bits, lowest first: most frames need one byte of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural::economy {

struct BatchHead {
    uint32_t sizeBytes = 0;
    bool sections = false; // besides Control
    bool operator==(const BatchHead&) const = default;
};

inline void putBatchHead(BatchHead head, std::vector<std::byte>& into) {
    uint32_t n = head.sizeBytes << 1 | static_cast<uint32_t>(head.sections);
    for (; n >= 128; n >>= 7) into.push_back(static_cast<std::byte>(n | 128));
    into.push_back(static_cast<std::byte>(n));
}

// Takes it byte by byte, as nobody knows before how many it has.
class BatchHeadReader {
public:
    static constexpr unsigned kMostBytes = 4;

    // False: more bytes are needed. Of one that would have more than any has the size is the largest there is.
    bool add(std::byte byte) {
        const auto b = static_cast<uint32_t>(byte);
        number_ |= (b & 127) << 7 * bytes_++;
        if (b >= 128 && bytes_ == kMostBytes) number_ = UINT32_MAX;
        return b < 128 || bytes_ == kMostBytes;
    }
    [[nodiscard]] BatchHead head() const { return {number_ >> 1, (number_ & 1) != 0}; }

private:
    uint32_t number_ = 0;
    unsigned bytes_ = 0;
};

} // namespace mural::economy
