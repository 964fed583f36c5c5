// Compression of batch sections. Each section kind has its own compressor, whose window contains earlier batches;
// uncompressed sections do not enter it. Both sides keep equal windows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace mural::delta {

enum class Coding : uint8_t { Empty = 0, Raw = 1, Lz4 = 2, Zstd = 3 };
constexpr size_t kCodings = 4;

// Returns the size of these bytes compressed independently with LZ4; 0 on failure.
[[nodiscard]] size_t lz4Bytes(std::span<const std::byte> bytes, std::vector<std::byte>& scratch);

class SectionCompressor {
public:
    explicit SectionCompressor(int zstdLevel = 1);
    ~SectionCompressor();
    SectionCompressor(SectionCompressor&&) noexcept;

    // Appends to `into`. `coding`: Lz4 or Zstd. The output must be sent, because the window contains it. Returns false
    // without memory.
    bool compress(Coding coding, std::span<const std::byte> bytes, std::vector<std::byte>& into);
    // Touches Zstandard's window in advance: page faults cost more than the compression that fills it.
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

    // Fills `into`. Returns false if the data is malformed or has another size.
    bool decompress(Coding coding, std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace mural::delta
