// A batch as it is sent, and back: one byte with two bits per section (its Coding), of each that is not empty its size and,
// compressed, its compressed size (in sevens), then the sections.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/result.hpp"
#include "economy/batch.hpp"
#include "economy/coding_choice.hpp"
#include "economy/section_codec.hpp"

namespace mural::economy {

class BatchEncoder {
public:
    // `nowNs`: a clock, to choose codings by what they cost.
    explicit BatchEncoder(std::function<int64_t()> nowNs) : nowNs_(std::move(nowNs)) {}

    // Lives until the next call. Error: no memory.
    Result<std::span<const std::byte>> encode(const SectionBytes& sections, double linkNsPerByte);

private:
    const std::function<int64_t()> nowNs_;
    std::array<SectionCompressor, kSections> compressors_;
    std::array<CodingChoice, kSections> choices_;
    std::array<std::vector<std::byte>, kSections> coded_;
    std::vector<std::byte> out_;
};

class BatchDecoder {
public:
    // Lives until the next call, and as long as `batch` does.
    Result<SectionBytes> decode(std::span<const std::byte> batch);

private:
    std::array<SectionDecompressor, kSections> decompressors_;
    std::array<std::vector<std::byte>, kSections> sections_;
};

} // namespace mural::economy
