// Sections of batches as compressed bytes. Each kind of section has its own compressor, whose window earlier batches fill;
// what goes uncompressed does not get there. Both sides do the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace mural::economy {

enum class Coding : uint8_t { Empty = 0, Raw = 1, Lz4 = 2, Zstd = 3 };
constexpr size_t kCodings = 4;

// What LZ4 makes of these bytes alone; 0: nothing.
[[nodiscard]] size_t lz4Bytes(std::span<const std::byte> bytes, std::vector<std::byte>& scratch);

class SectionCompressor {
public:
    explicit SectionCompressor(int zstdLevel = 1);
    ~SectionCompressor();
    SectionCompressor(SectionCompressor&&) noexcept;

    // Adds to `into`; `coding`: Lz4 or Zstd. What it has made must be sent: the window holds it. False: no memory.
    bool compress(Coding coding, std::span<const std::byte> bytes, std::vector<std::byte>& into);
    // Touches Zstandard's window, so that the first frames need not: new memory costs more than to compress what fills it.
    void prepare();

private:
    struct State;
    std::unique_ptr<State> state_;
};

class SectionDecompressor {
public:
    SectionDecompressor();
    ~SectionDecompressor();
    SectionDecompressor(SectionDecompressor&&) noexcept;

    // Fills `into`; false: they are not so many bytes, or nothing that the compressor makes.
    bool decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace mural::economy
