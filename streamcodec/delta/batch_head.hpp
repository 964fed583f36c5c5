// Head of a batch: the number of following bytes, and whether sections besides Control follow. A varint; most frames
// need one byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mural::delta {

struct BatchHead {
    uint32_t sizeBytes = 0;
    bool sections = false; // sections besides Control follow
    bool operator==(const BatchHead&) const = default;
};

inline void putBatchHead(BatchHead head, std::vector<std::byte>& into) {
    uint32_t n = head.sizeBytes << 1 | static_cast<uint32_t>(head.sections);
    for (; n >= 128; n >>= 7) into.push_back(static_cast<std::byte>(n | 128));
    into.push_back(static_cast<std::byte>(n));
}

// Reads a head byte by byte, because its length is unknown in advance.
class BatchHeadReader {
public:
    static constexpr unsigned kMaxBytes = 4;

    // Returns false while bytes are missing. A size beyond the valid range saturates.
    bool add(std::byte byte) {
        const auto b = static_cast<uint32_t>(byte);
        number_ |= (b & 127) << 7 * bytes_++;
        if (b >= 128 && bytes_ == kMaxBytes) number_ = UINT32_MAX;
        return b < 128 || bytes_ == kMaxBytes;
    }
    [[nodiscard]] BatchHead head() const { return {number_ >> 1, (number_ & 1) != 0}; }

private:
    uint32_t number_ = 0;
    unsigned bytes_ = 0;
};

} // namespace mural::delta
