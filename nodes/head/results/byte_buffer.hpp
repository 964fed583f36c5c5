// Uninitialised heap memory for pictures and replies, which are large and written once.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>

namespace mural {

class ByteBuffer {
public:
    ByteBuffer() = default;
    // Returns an empty buffer if the allocation fails: sizes come from the network.
    static ByteBuffer ofSize(size_t sizeBytes) {
        ByteBuffer buffer;
        buffer.bytes_.reset(new (std::nothrow) std::byte[sizeBytes]);
        if (buffer.bytes_) buffer.sizeBytes_ = sizeBytes;
        return buffer;
    }

    [[nodiscard]] size_t size() const { return sizeBytes_; }
    std::byte* data() { return bytes_.get(); }
    [[nodiscard]] const std::byte* data() const { return bytes_.get(); }
    std::span<std::byte> span() { return {bytes_.get(), sizeBytes_}; }
    [[nodiscard]] std::span<const std::byte> span() const { return {bytes_.get(), sizeBytes_}; }

private:
    std::unique_ptr<std::byte[]> bytes_;
    size_t sizeBytes_ = 0;
};

} // namespace mural
