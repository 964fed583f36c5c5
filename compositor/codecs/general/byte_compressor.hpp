// Compressors of plain bytes, which know nothing of pictures.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace mural::compositor {

class ByteCompressor {
public:
    virtual ~ByteCompressor() = default;
    [[nodiscard]] virtual size_t boundBytes(size_t sizeBytes) const = 0;
    // `into` has boundBytes. Returns the bytes written, 0 when there is no memory.
    [[nodiscard]] virtual size_t compress(std::span<const std::byte> bytes, std::span<std::byte> into) = 0;
    // Whether `bytes` are exactly as many as `into` holds, compressed.
    [[nodiscard]] virtual bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into) = 0;
};

// LZ4 of its usual speed, 2 GiB at most.
[[nodiscard]] std::unique_ptr<ByteCompressor> makeLz4();
// Levels below zero are faster; 1 to 3 are what pictures profit from.
[[nodiscard]] std::unique_ptr<ByteCompressor> makeZstd(int level);

} // namespace mural::compositor
