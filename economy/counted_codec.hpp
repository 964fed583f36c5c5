// Bytes by how often each comes, and nothing else: Huffman codes of Zstandard's, each section a frame of its own. Of what is left of a
// photograph next to nothing repeats, and to look for it takes longer than all else that is done for its bytes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace mural::economy {

class CountedCompressor {
public:
    CountedCompressor();
    ~CountedCompressor();
    CountedCompressor(CountedCompressor&&) noexcept;

    // Whether repeats in them, as far as two samples show, are worth no more than their counts.
    [[nodiscard]] bool suits(std::span<const std::byte> bytes);
    // Adds to `into`. False: no memory for it.
    bool compress(std::span<const std::byte> bytes, std::vector<std::byte>& into);
    // Touches its memory, so that the first frames need not.
    void prepare();

private:
    struct State;
    std::unique_ptr<State> state_;
};

class CountedDecompressor {
public:
    CountedDecompressor();
    ~CountedDecompressor();
    CountedDecompressor(CountedDecompressor&&) noexcept;

    // Fills `into`; false: they are not so many bytes, or nothing that the compressor makes.
    bool decompress(std::span<const std::byte> bytes, std::span<std::byte> into);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace mural::economy
