// Serializes a batch. A batch with only a Control section consists of its bytes. Otherwise it starts with one byte that
// holds two bits (Coding) per other section, followed by the sizes of non-empty sections as varints (uncompressed, and
// compressed if it is), then the sections; Control takes the rest.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/base/result.hpp"
#include "streamcodec/delta/batch.hpp"
#include "streamcodec/delta/batch_head.hpp"
#include "streamcodec/delta/entropy/section_codec_selector.hpp"
#include "streamcodec/delta/entropy/page_codec.hpp"
#include "streamcodec/delta/entropy/section_codec.hpp"

namespace mural::delta {

class BatchEncoder {
public:
    // `nowNs`: clock that times the compression of the given number of bytes; the selection of codings uses it.
    explicit BatchEncoder(std::function<int64_t(size_t sizeBytes)> nowNs) : nowNs_(std::move(nowNs)) {
        for (const Section section : {Section::Texts, Section::Words, Section::Spans})
            compressors_[static_cast<size_t>(section)].prepare();
        pages_.prepare();
    }

    // Returns the batch with its head, valid until the next call. `plain`: the Texts section holds mostly plain records
    // (DeltaEncoder::beginFrame), so its compressor uses a window that contains previous frames. Error: out of memory.
    Result<std::span<const std::byte>> encode(const SectionBytes& sections, double linkNsPerByte, bool plain = false);
    // Returns the measured compression ratio of this section.
    [[nodiscard]] double ratio(Section section) const { return choices_[static_cast<size_t>(section)].ratio(); }

private:
    Result<void> encodeSections(const SectionBytes& sections, double linkNsPerByte, bool plain);

    const std::function<int64_t(size_t)> nowNs_;
    bool compress(size_t section, Coding coding, std::span<const std::byte> bytes); // appends to coded_

    // The entries for Control and Pages are unused. Texts use the fastest level, which finds equal frames and records
    // as well.
    std::array<SectionCompressor, kSections> compressors_{
        SectionCompressor(), SectionCompressor(), SectionCompressor(-1), SectionCompressor(), SectionCompressor()};
    PageCompressor pages_;
    std::array<SectionCodecSelector, kSections> choices_;
    std::array<std::vector<std::byte>, kSections> coded_;
    std::vector<std::byte> body_, out_, scratch_;
};

class BatchDecoder {
public:
    // Decodes the bytes after `head`. The result is valid until the next call, and as long as `body`.
    Result<SectionBytes> decode(BatchHead head, std::span<const std::byte> body);

private:
    bool decompress(size_t section, Coding coding, std::span<const std::byte> bytes); // appends to sections_

    std::array<SectionDecompressor, kSections> decompressors_; // the entry for Pages is unused
    PageDecompressor pages_;
    std::array<std::vector<std::byte>, kSections> sections_;
};

} // namespace mural::delta
