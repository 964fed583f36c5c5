// Writes values as bytes: little-endian, without alignment.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include <mural/archive/byte_buffer.hpp>
#include <mural/blob.hpp>

namespace mural::archive {

static_assert(std::endian::native == std::endian::little, "Mural supports little-endian machines only");

template <class T> struct Codec; // mural/archive/codecs.hpp

// The visitor that `fields` receives while an object is encoded. Also the sink of the codecs.
class Encoder {
public:
    template <class... Fields> void operator()(Fields&... fields) {
        (Codec<std::remove_const_t<Fields>>::encode(*this, fields), ...);
    }
    template <class Field> Encoder& operator&(Field& field) {
        (*this)(field);
        return *this;
    }

    void bytes(const void* from, size_t count) { out_.append(from, count); }
    template <class T> void plain(const T& value) { std::memcpy(out_.grow(sizeof(T)), &value, sizeof(T)); }
    // Writes the number of elements of a container, at most 2^32 - 1. A larger number makes the encoding fail.
    void count(size_t elements) {
        if (elements > UINT32_MAX) isTooLarge_ = true;
        plain(static_cast<uint32_t>(elements));
    }
    // Notes a blob that the written bytes refer to.
    void refer(const Blob& blob) { blobs_.push_back(blob); }

    void clear() {
        out_.clear();
        blobs_.clear();
        isTooLarge_ = false;
    }
    [[nodiscard]] const ByteBuffer& out() const { return out_; }
    [[nodiscard]] const std::vector<Blob>& blobs() const { return blobs_; }
    [[nodiscard]] bool isTooLarge() const { return isTooLarge_; }

private:
    ByteBuffer out_;
    std::vector<Blob> blobs_;
    bool isTooLarge_ = false;
};

} // namespace mural::archive
