// General-purpose byte compressors.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace mural::compositor {

class ByteCompressor {
public:
    virtual ~ByteCompressor() = default;
    [[nodiscard]] virtual size_t boundBytes(size_t sizeBytes) const = 0;
    // Returns the number of bytes written, 0 without memory. Requires boundBytes() in `into`.
    [[nodiscard]] virtual size_t compress(std::span<const std::byte> bytes, std::span<std::byte> into) = 0;
    // Returns true if `bytes` decompress to exactly the size of `into`.
    [[nodiscard]] virtual bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into) = 0;
};

// LZ4 at default speed, at most 2 GiB.
[[nodiscard]] std::unique_ptr<ByteCompressor> makeLz4();
// Zstandard. Levels below zero are faster; levels 1 to 3 suit pictures.
[[nodiscard]] std::unique_ptr<ByteCompressor> makeZstd(int level);

} // namespace mural::compositor
