// Reads values from bytes that may be damaged.
#pragma once

#include <cstring>
#include <type_traits>

#include <mural/archive/encoder.hpp>

namespace mural::archive {

// The blobs that encoded bytes may refer to.
class BlobSource {
public:
    virtual ~BlobSource() = default;
    // Returns null if the blob is not available.
    [[nodiscard]] virtual const Blob* find(const BlobName& name) const = 0;
};

// The visitor that `fields` receives while an object is decoded. Also the source of the codecs.
//
// Every read is checked against the remaining bytes. After the first error all reads fail and values stay as they are.
// Memory grows only with bytes that were read.
class Decoder {
public:
    explicit Decoder(std::span<const std::byte> bytes, const BlobSource* blobs = nullptr)
        : at_(bytes.data()), end_(bytes.data() + bytes.size()), blobs_(blobs) {}

    template <class... Fields> void operator()(Fields&... fields) {
        static_assert((!std::is_const_v<Fields> && ...),
                      "decoding writes the fields: neither they nor the function fields() may be const");
        (Codec<Fields>::decode(*this, fields), ...);
    }
    template <class Field> Decoder& operator&(Field& field) {
        (*this)(field);
        return *this;
    }

    // Returns the next bytes, or null if fewer are left.
    const std::byte* take(size_t count) {
        if (count > left()) {
            fail("ends too early");
            return nullptr;
        }
        const std::byte* const from = at_;
        at_ += count;
        return from;
    }
    template <class T> bool plain(T& value) {
        const std::byte* const from = take(sizeof(T));
        if (from) std::memcpy(&value, from, sizeof(T));
        return from != nullptr;
    }
    // Reads the number of elements of a container. Each element takes at least one byte.
    uint32_t count() {
        uint32_t elements = 0;
        plain(elements);
        if (elements <= left()) return elements;
        fail("has a length beyond its end");
        return 0;
    }
    // Only the first problem counts. `problem` is the rest of a sentence that begins with the field, with static
    // lifetime.
    void fail(const char* problem) {
        if (!problem_) problem_ = problem;
        at_ = end_;
    }

    [[nodiscard]] size_t left() const { return static_cast<size_t>(end_ - at_); }
    [[nodiscard]] bool ok() const { return problem_ == nullptr; }
    [[nodiscard]] const char* problem() const { return problem_; } // null: none
    [[nodiscard]] const BlobSource* blobs() const { return blobs_; }

private:
    const std::byte* at_;
    const std::byte* end_;
    const BlobSource* blobs_;
    const char* problem_ = nullptr;
};

} // namespace mural::archive
