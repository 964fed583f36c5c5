// Entropy coding without match search: Zstandard's Huffman codes, one frame per section. Filtered photographs contain
// next to no repeats, and a search for them takes longer than all other stages.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace mural::delta {

class HuffmanCompressor {
public:
    HuffmanCompressor();
    ~HuffmanCompressor();
    HuffmanCompressor(HuffmanCompressor&&) noexcept;

    // Returns true if repeats in two samples save no more than their byte counts.
    [[nodiscard]] bool suits(std::span<const std::byte> bytes);
    // Appends to `into`. Returns false without memory.
    bool compress(std::span<const std::byte> bytes, std::vector<std::byte>& into);
    // Touches the memory in advance, so that the first frames have no page faults.
    void prepare();

private:
    struct State;
    std::unique_ptr<State> state_;
};

class HuffmanDecompressor {
public:
    HuffmanDecompressor();
    ~HuffmanDecompressor();
    HuffmanDecompressor(HuffmanDecompressor&&) noexcept;

    // Fills `into`. Returns false if the data is malformed or has another size.
    bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace mural::delta
