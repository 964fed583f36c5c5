// The control bytes of a batch: operations with counts. docs/reference/wire-format.md has the grammar.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "streamcodec/delta/entropy/byte_predictor.hpp"
#include "streamcodec/delta/entropy/range_coder.hpp"

namespace mural::delta {

enum class DeltaOp : uint8_t {
    Run = 0,       // n entries follow in the previous order
    Patch = 1,     // the expected entry with n spans of changed words
    NewText = 2,   // new short entry of n words
    NewPage = 3,   // new page of n words; 0: a whole page
    Skip = 4,      // n expected entries are omitted
    Seek = 5,      // the next entry occurred n entries ago
    Pages = 6,     // n consecutive pages of the store, from the slot that follows
    ControlOp = 7, // n selects the operation below
};

enum class ControlOp : uint32_t {
    End = 1,          // end of the packet
    Stream = 2,       // the stream of the packet follows; otherwise it is the previous packet's
    Bytes = 3,        // plain bytes; their number follows
    Done = 4,         // end of the batch
    CachedBytes = 5,  // as Bytes, and cached in the slot that follows
    ChangedBytes = 6, // the bytes of the slot that follows, with spans of changed words; their number follows
};

// Writes a span: unchanged words, then changed words (at least one). One byte holds four bits of each; 15: the rest
// follows as a varint.
inline void putSpan(uint32_t unchanged, uint32_t changed, auto&& byte) {
    const auto number = [&](uint32_t n) {
        for (; n >= 128; n >>= 7) byte((n & 127) | 128);
        byte(n);
    };
    const uint32_t high = unchanged < 15 ? unchanged : 15, low = changed - 1 < 15 ? changed - 1 : 15;
    byte(high << 4 | low);
    if (high == 15) number(unchanged - 15);
    if (low == 15) number(changed - 1 - 15);
}

// Writes an operation with its count: three bits of DeltaOp, five bits of the count; 31: the rest follows as a varint.
class ControlWriter {
public:
    explicit ControlWriter(RangeWriter& coder) : coder_(coder) {}

    void put(DeltaOp what, uint32_t n) {
        const uint32_t low = n < 31 ? n : 31;
        byte(static_cast<uint32_t>(what) << 5 | low);
        if (low == 31) number(n - 31);
    }
    void put(ControlOp what) { put(DeltaOp::ControlOp, static_cast<uint32_t>(what)); }
    void number(uint32_t n) {
        for (; n >= 128; n >>= 7) byte((n & 127) | 128);
        byte(n);
    }
    void span(uint32_t unchanged, uint32_t changed) {
        mural::delta::putSpan(unchanged, changed, [this](uint32_t value) { byte(value); });
    }
    // upper estimate, without prediction
    static uint32_t spanBytes(uint32_t unchanged, uint32_t changed) { return 1 + (unchanged >= 15) + (changed >= 16); }

private:
    void byte(uint32_t value) { predictor_.code(coder_, value); }

    RangeWriter& coder_;
    BytePredictor predictor_;
};

// After the end, or after a number out of range, every value is 0 and bad() is true.
template <class Source> class NumberReader {
public:
    explicit NumberReader(Source source) : source_(std::move(source)) {}

    [[nodiscard]] bool bad() const { return bad_ || source_.bad(); }
    DeltaOp what(uint32_t& n) {
        const uint32_t b = byte();
        n = b & 31;
        if (n == 31) n = plus(31, number());
        return static_cast<DeltaOp>(b >> 5);
    }
    uint32_t number() {
        uint64_t n = 0;
        for (uint32_t shift = 0; shift < 35; shift += 7) {
            const uint32_t b = byte();
            n |= uint64_t{b & 127} << shift;
            if (b < 128) return n <= UINT32_MAX ? static_cast<uint32_t>(n) : fail();
        }
        return fail();
    }
    void span(uint32_t& unchanged, uint32_t& changed) {
        const uint32_t b = byte();
        unchanged = b >> 4, changed = b & 15;
        if (unchanged == 15) unchanged = plus(15, number());
        if (changed == 15) changed = plus(15, number());
        changed = plus(1, changed);
    }
    [[nodiscard]] Source& source() { return source_; }
    void clear() { bad_ = false; }

private:
    uint32_t byte() { return bad() ? 0 : source_.byte(); }
    uint32_t plus(uint32_t a, uint32_t b) { return b <= UINT32_MAX - a ? a + b : fail(); }
    uint32_t fail() {
        bad_ = true;
        return 0;
    }

    Source source_;
    bool bad_ = false;
};

class CodedBytes {
public:
    explicit CodedBytes(RangeReader& coder) : coder_(coder) {}
    [[nodiscard]] bool bad() const { return coder_.bad(); }
    uint32_t byte() { return predictor_.code(coder_, 0); }

private:
    RangeReader& coder_;
    BytePredictor predictor_;
};

class PlainBytes {
public:
    explicit PlainBytes(std::span<const std::byte> bytes = {}) : bytes_(bytes) {}
    [[nodiscard]] bool bad() const { return missing_; }
    uint32_t byte() {
        missing_ = missing_ || at_ == bytes_.size();
        return missing_ ? 0 : static_cast<uint32_t>(bytes_[at_++]);
    }

private:
    std::span<const std::byte> bytes_;
    size_t at_ = 0;
    bool missing_ = false;
};

using ControlReader = NumberReader<CodedBytes>;
using SpanReader = NumberReader<PlainBytes>;

} // namespace mural::delta
