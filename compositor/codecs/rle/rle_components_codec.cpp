#include "compositor/codecs/rle/rle_components_codec.hpp"

#include <cstring>

#include "common/base/little_endian.hpp"

namespace mural::compositor {

namespace {

constexpr uint8_t kMarker = 0x42;
constexpr unsigned kShortestRun = 4;
constexpr unsigned kLongestRun = 255;
constexpr size_t kStreams = 4;

class StreamWriter {
public:
    explicit StreamWriter(std::byte* out) : out_(out) {}
    void add(uint8_t value) {
        if (count_ > 0 && value == value_ && count_ < kLongestRun) {
            ++count_;
            return;
        }
        end();
        value_ = value;
        count_ = 1;
    }
    std::byte* end() {
        if (count_ >= kShortestRun || (count_ > 0 && value_ == kMarker)) {
            *out_++ = std::byte{kMarker};
            *out_++ = std::byte{value_};
            *out_++ = static_cast<std::byte>(count_);
        } else {
            for (unsigned i = 0; i < count_; ++i) *out_++ = std::byte{value_};
        }
        count_ = 0;
        return out_;
    }

private:
    std::byte* out_;
    unsigned count_ = 0;
    uint8_t value_ = 0;
};

class StreamReader {
public:
    explicit StreamReader(std::span<const std::byte> left) : left_(left) {}
    // Returns false at the end, or for malformed data.
    bool next(uint8_t& value) {
        if (count_ == 0 && !begin()) return false;
        --count_;
        value = value_;
        return true;
    }
    [[nodiscard]] bool ended() const { return left_.empty() && count_ == 0; }

private:
    bool begin() {
        if (left_.empty()) return false;
        const auto first = std::to_integer<uint8_t>(left_[0]);
        const size_t taken = first == kMarker ? 3 : 1;
        if (left_.size() < taken) return false;
        value_ = taken == 3 ? std::to_integer<uint8_t>(left_[1]) : first;
        count_ = taken == 3 ? std::to_integer<unsigned>(left_[2]) : 1;
        left_ = left_.subspan(taken);
        return count_ > 0;
    }
    std::span<const std::byte> left_;
    unsigned count_ = 0;
    uint8_t value_ = 0;
};

} // namespace

// Transposes a matrix of 4 x 4 bit pairs: first by halves, then within them.
uint32_t swizzledWord(uint32_t word) {
    const uint32_t halves = (word ^ word >> 20) & 0x00000f0f;
    word ^= halves ^ halves << 20;
    const uint32_t pairs = (word ^ word >> 10) & 0x00330033;
    return word ^ pairs ^ pairs << 10;
}

size_t RleComponentsCodec::boundBytes(const PlaneShape& shape) const {
    if (shape.width <= 0 || shape.height <= 0) return 0;
    return kStreams * 4 + 3 * shape.sizeBytes(); // worst case: every byte is an isolated marker
}

Result<size_t> RleComponentsCodec::encode(const PlaneView& plane, std::span<std::byte> into) {
    if (plane.empty()) return size_t{0};
    std::byte* out = into.data();
    for (unsigned stream = 0; stream < kStreams; ++stream) {
        StreamWriter writer(out + 4);
        for (int32_t y = 0; y < plane.height; ++y) {
            const std::byte* row = plane.row(y);
            for (size_t at = 0; at < plane.rowBytes(); at += 4) {
                uint32_t word;
                std::memcpy(&word, row + at, sizeof word);
                writer.add(static_cast<uint8_t>((swizzled_ ? swizzledWord(word) : word) >> (8 * stream)));
            }
        }
        std::byte* end = writer.end();
        storeLittle(out, static_cast<uint32_t>(end - out - 4));
        out = end;
    }
    return static_cast<size_t>(out - into.data());
}

Result<void> RleComponentsCodec::decode(std::span<const std::byte> bytes, const MutablePlaneView& into) {
    const auto damaged = [&](const char* what) {
        return damagedPlane(swizzled_ ? "rle-swizzled" : "rle-components", into, bytes.size(), what);
    };
    if (into.empty()) return bytes.empty() ? Result<void>() : damaged("an empty plane has no bytes");
    std::span<const std::byte> streams[kStreams];
    std::span<const std::byte> left = bytes;
    for (auto& stream : streams) {
        if (left.size() < 4) return damaged("a stream's size is missing");
        const size_t size = loadLittle<uint32_t>(left.data());
        left = left.subspan(4);
        if (size > left.size()) return damaged("a stream is truncated");
        stream = left.first(size);
        left = left.subspan(size);
    }
    if (!left.empty()) return damaged("there are bytes after its end");
    StreamReader readers[kStreams] = {StreamReader(streams[0]), StreamReader(streams[1]), StreamReader(streams[2]),
                                      StreamReader(streams[3])};
    for (int32_t y = 0; y < into.height; ++y) {
        std::byte* row = into.row(y);
        for (size_t at = 0; at < into.rowBytes(); at += 4) {
            uint32_t word = 0;
            for (unsigned stream = 0; stream < kStreams; ++stream) {
                uint8_t value;
                if (!readers[stream].next(value)) return damaged("a stream ends before its plane");
                word |= uint32_t{value} << (8 * stream);
            }
            if (swizzled_) word = swizzledWord(word);
            std::memcpy(row + at, &word, sizeof word);
        }
    }
    for (const StreamReader& r : readers)
        if (!r.ended()) return damaged("a stream continues after its plane");
    return {};
}

} // namespace mural::compositor
