// Growable bytes that are not cleared before they are written.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <utility>

namespace mural::archive {

// Appending costs one comparison and one copy. Growth uses realloc, which moves large memory without a copy.
class ByteBuffer {
public:
    ByteBuffer() = default;
    ~ByteBuffer() { std::free(data_); }
    ByteBuffer(ByteBuffer&& other) noexcept { swap(other); }
    ByteBuffer& operator=(ByteBuffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ByteBuffer(const ByteBuffer&) = delete;
    ByteBuffer& operator=(const ByteBuffer&) = delete;

    void append(const void* from, size_t count) {
        if (count == 0) return;
        std::memcpy(grow(count), from, count);
    }
    // Returns room for `count` further bytes, which the caller writes.
    std::byte* grow(size_t count) {
        if (capacity_ - size_ < count) enlarge(count);
        std::byte* const at = data_ + size_;
        size_ += count;
        return at;
    }
    // Keeps the memory for the next use.
    void clear() { size_ = 0; }
    [[nodiscard]] size_t size() const { return size_; }
    [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }
    [[nodiscard]] std::span<const std::byte> bytes(size_t from, size_t end) const { return {data_ + from, end - from}; }

private:
    void swap(ByteBuffer& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }
    void enlarge(size_t count) {
        size_t capacity = capacity_ < 256 ? 256 : capacity_ * 2;
        if (capacity - size_ < count) capacity = size_ + count;
        void* const moved = std::realloc(data_, capacity);
        if (!moved) throw std::bad_alloc();
        data_ = static_cast<std::byte*>(moved);
        capacity_ = capacity;
    }

    std::byte* data_ = nullptr;
    size_t size_ = 0;
    size_t capacity_ = 0;
};

} // namespace mural::archive
