// Predicts the bytes of a repetitive section: the byte that last followed the same context. Equal sequences of any
// length cost hundredths of a bit per byte.
#pragma once

#include <array>
#include <cstdint>

#include "streamcodec/delta/entropy/range_coder.hpp"

namespace mural::delta {

class BytePredictor {
public:
    template <class Coder> uint32_t code(Coder& coder, uint32_t value) {
        Expected& far = far_[(before_ * 0x9e3779b97f4a7c15u) >> (64 - kFarBits)];
        Expected& near = near_[((before_ & 0xffff) * 0x9e3779b1u & UINT32_MAX) >> (32 - kNearBits)];
        const uint32_t expected = far.byte, other = near.byte;
        const bool farTried = far.trust != 0, nearTried = near.trust != 0 && !(farTried && other == expected);
        if (farTried && coder.code(farHit_[far.trust], value == expected))
            value = expected;
        else if (nearTried && coder.code(nearHit_[farTried][near.trust], value == other))
            value = other;
        else
            value = bytes_.code(coder, value);
        far.update(value);
        near.update(value);
        before_ = before_ << 8 | value;
        return value;
    }

private:
    static constexpr unsigned kFarBits = 12, kNearBits = 10;
    static constexpr uint8_t kMaxTrust = 15;
    struct Expected {
        uint8_t byte = 0;
        uint8_t trust = 0; // confidence; 0: no prediction
        void update(uint32_t value) {
            if (trust != 0 && byte == value)
                trust = trust < kMaxTrust ? static_cast<uint8_t>(trust + 1) : kMaxTrust;
            else if (trust > 1)
                trust = static_cast<uint8_t>(trust / 4 + 1);
            else
                byte = static_cast<uint8_t>(value), trust = 1;
        }
    };

    std::array<Expected, 1u << kFarBits> far_{};   // by a context of eight bytes
    std::array<Expected, 1u << kNearBits> near_{}; // by a context of two bytes
    std::array<BitModel, kMaxTrust + 1> farHit_{};
    std::array<std::array<BitModel, kMaxTrust + 1>, 2> nearHit_{};
    ByteModel bytes_;
    uint64_t before_ = 0;
};

} // namespace mural::delta
