// A batch as it is sent, and back. With no section but Control it is that. Else one byte with two bits per other section (its Coding),
// of each that is not empty its size and, compressed, its compressed size (in sevens), then the sections, Control as what is left.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/result.hpp"
#include "economy/batch.hpp"
#include "economy/batch_head.hpp"
#include "economy/coding_choice.hpp"
#include "economy/page_codec.hpp"
#include "economy/section_codec.hpp"

namespace mural::economy {

class BatchEncoder {
public:
    // `nowNs`: the clock by which to compress so many bytes is timed, to choose codings by what they cost.
    explicit BatchEncoder(std::function<int64_t(size_t sizeBytes)> nowNs) : nowNs_(std::move(nowNs)) {
        for (const Section section : {Section::Texts, Section::Words, Section::Spans}) compressors_[static_cast<size_t>(section)].prepare();
        pages_.prepare();
    }

    // With its head. Lives until the next call. `plain`: its texts are mostly records that were not looked at (Packer::beginFrame), so it
    // takes a window that has the frames before.
    // Error: no memory.
    Result<std::span<const std::byte>> encode(const SectionBytes& sections, double linkNsPerByte, bool plain = false);
    // What compressing makes of a byte of this section, by what was measured.
    [[nodiscard]] double ratio(Section section) const { return choices_[static_cast<size_t>(section)].ratio(); }

private:
    Result<void> encodeSections(const SectionBytes& sections, double linkNsPerByte, bool plain);

    const std::function<int64_t(size_t)> nowNs_;
    bool compress(size_t section, Coding coding, std::span<const std::byte> bytes); // to coded_

    // Those of Control and Pages are not used. Texts: equal frames and records are found as well by the fastest level.
    std::array<SectionCompressor, kSections> compressors_{SectionCompressor(), SectionCompressor(), SectionCompressor(-1), SectionCompressor(), SectionCompressor()};
    PageCompressor pages_;
    std::array<CodingChoice, kSections> choices_;
    std::array<std::vector<std::byte>, kSections> coded_;
    std::vector<std::byte> body_, out_, scratch_;
};

class BatchDecoder {
public:
    // What follows `head`. Lives until the next call, and as long as `body` does.
    Result<SectionBytes> decode(BatchHead head, std::span<const std::byte> body);

private:
    bool decompress(size_t section, Coding coding, std::span<const std::byte> bytes); // to sections_

    std::array<SectionDecompressor, kSections> decompressors_; // that of Pages is not used
    PageDecompressor pages_;
    std::array<std::vector<std::byte>, kSections> sections_;
};

} // namespace mural::economy
