// Numbers of a binary file in either byte order. The first problem is kept with its byte; later calls return zeros.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/base/result.hpp"

namespace mural::examples {

// Reads a number from unaligned memory.
template <class T> T loadNumber(const char* from, std::endian order) {
    static_assert(std::is_arithmetic_v<T>);
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), from, sizeof(T));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

class ByteCursor {
public:
    // `bytes` must outlive the cursor. `offset`: the position of the first byte in the file, for messages.
    ByteCursor(std::string_view bytes, std::string file, std::endian order, size_t offset = 0)
        : bytes_(bytes), file_(std::move(file)), order_(order), offset_(offset) {}

    template <class T> T take(const char* what) {
        if (bytesLeft() < sizeof(T)) {
            fail(std::string("ends before ") + what);
            return T{};
        }
        const T value = loadNumber<T>(bytes_.data() + at_, order_);
        at_ += sizeof(T);
        return value;
    }

    [[nodiscard]] size_t bytesLeft() const { return bytes_.size() - at_; }
    [[nodiscard]] bool ok() const { return problem_.empty(); }
    void fail(const std::string& what) {
        if (ok()) problem_ = file_ + ": byte " + std::to_string(offset_ + at_) + ": " + what;
        at_ = bytes_.size();
    }
    [[nodiscard]] Error error() const { return Error{problem_}; }

private:
    std::string_view bytes_;
    std::string file_;
    std::endian order_;
    size_t offset_;
    size_t at_ = 0;
    std::string problem_;
};

} // namespace mural::examples
