// Reads the arguments of a record. The stream is a trust boundary: every read is checked against the record's end.
// After a failed read all values are zero and ok() is false.
#pragma once

#include <GL/gl.h>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "streamcodec/wire/record.hpp"

namespace mural {

// A variable-size value: inline bytes, a blob, an offset into a bound buffer, or null.
class Data {
public:
    Data() = default;
    static Data bytes(const std::byte* p, uint64_t n) { return Data(p, n, false); }
    static Data offset(uint64_t o) { return Data(reinterpret_cast<const std::byte*>(o), 0, true); }

    [[nodiscard]] bool isOffset() const { return isOffset_; }
    [[nodiscard]] bool absent() const { return !isOffset_ && !pointer_; }
    [[nodiscard]] uint64_t size() const { return size_; }
    // True if GL may read n bytes: they are present, the value is null, or a buffer is bound.
    [[nodiscard]] bool covers(uint64_t n) const { return isOffset_ || !pointer_ || size_ >= n; }
    [[nodiscard]] bool isText() const { return !pointer_ || (size_ > 0 && pointer_[size_ - 1] == std::byte{0}); }
    [[nodiscard]] const void* pointer() const { return pointer_; }
    template <class T> [[nodiscard]] const T* as() const { return reinterpret_cast<const T*>(pointer_); }
    [[nodiscard]] std::span<const std::byte> span() const {
        return isOffset_ || !pointer_ ? std::span<const std::byte>{} : std::span{pointer_, static_cast<size_t>(size_)};
    }

private:
    Data(const std::byte* p, uint64_t n, bool offset) : pointer_(p), size_(n), isOffset_(offset) {}
    const std::byte* pointer_ = nullptr;
    uint64_t size_ = 0;
    bool isOffset_ = false;
};

// Holds the blobs of a stream until their command takes them.
class BlobQueue {
public:
    virtual ~BlobQueue() = default;
    // Takes the oldest complete blob; valid until the record has been replayed. found: false if there is none.
    virtual std::span<const std::byte> takeBlob(bool& found) = 0;
};

// The queue of a record without blobs.
class NoBlobs : public BlobQueue {
public:
    std::span<const std::byte> takeBlob(bool& found) override {
        found = false;
        return {};
    }
};

class Args {
public:
    Args(std::span<const std::byte> arguments, BlobQueue& blobs)
        : at_(arguments.data()), end_(arguments.data() + arguments.size()), blobs_(&blobs) {}

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] size_t left() const { return static_cast<size_t>(end_ - at_); }

    template <class T> T get() {
        T value{};
        if (const std::byte* p = take(sizeof(T))) std::memcpy(&value, p, sizeof(T));
        return value;
    }
    // Reads a value of one or two bytes, stored in four.
    template <class T> T narrow() {
        const auto word = get<uint32_t>();
        T value{};
        std::memcpy(&value, &word, sizeof(T));
        return value;
    }
    template <class T> const T* fixed(size_t bytes) { return reinterpret_cast<const T*>(take((bytes + 3) / 4 * 4)); }

    Data data() {
        const auto tag = get<uint32_t>();
        if (tag == record::kTagNull) return {};
        if (tag == record::kTagOffset) return Data::offset(get<uint64_t>());
        if (tag == record::kTagBlob) {
            bool found = false;
            const auto blob = blobs_->takeBlob(found);
            ok_ = ok_ && found;
            return found ? Data::bytes(blob.data(), blob.size()) : Data{};
        }
        if (tag > record::kInlineBytes) ok_ = false;
        const std::byte* p = ok_ ? take((size_t{tag} + 3) / 4 * 4) : nullptr;
        return p ? Data::bytes(p, tag) : Data{};
    }

    // Reads a value that must not be an offset, which GL would use as an address.
    Data values() {
        const Data d = data();
        if (!d.isOffset()) return d;
        ok_ = false;
        return {};
    }

private:
    const std::byte* take(size_t bytes) {
        if (!ok_ || left() < bytes) {
            ok_ = false;
            return nullptr;
        }
        const std::byte* p = at_;
        at_ += bytes;
        return p;
    }

    const std::byte* at_;
    const std::byte* end_;
    BlobQueue* blobs_;
    bool ok_ = true;
};

// Inverse of packStrings (interposer/encode/encode_support.hpp): lengths, then text.
class StringList {
public:
    bool parse(const Data& d, int64_t count) {
        if (count < 0 || count > 1 << 20) return false;
        const auto n = static_cast<size_t>(count);
        if (n == 0) return true;
        const auto bytes = d.span();
        if (bytes.size() < 4 * n) return false;
        size_t at = 4 * n;
        text_.reserve(bytes.size());
        for (size_t i = 0; i < n; ++i) {
            uint32_t length = 0;
            std::memcpy(&length, bytes.data() + 4 * i, 4);
            if (length > bytes.size() - at) return false;
            starts_.push_back(text_.size());
            lengths_.push_back(static_cast<GLint>(length));
            text_.insert(text_.end(), reinterpret_cast<const char*>(bytes.data()) + at,
                         reinterpret_cast<const char*>(bytes.data()) + at + length);
            text_.push_back(0);
            at += length;
        }
        for (const size_t s : starts_) pointers_.push_back(text_.data() + s);
        return true;
    }
    [[nodiscard]] const GLchar* const* pointers() const { return pointers_.data(); }
    [[nodiscard]] const GLint* lengths() const { return lengths_.data(); }
    [[nodiscard]] size_t count() const { return pointers_.size(); }
    [[nodiscard]] std::string joined() const {
        std::string all;
        for (size_t i = 0; i < pointers_.size(); ++i) all.append(pointers_[i], static_cast<size_t>(lengths_[i]));
        return all;
    }

private:
    std::vector<char> text_;
    std::vector<size_t> starts_;
    std::vector<const GLchar*> pointers_;
    std::vector<GLint> lengths_;
};

} // namespace mural
