#include "economy/batch_codec.hpp"

#include "economy/control_code.hpp"
#include "economy/limits.hpp"

namespace mural::economy {

Result<std::span<const std::byte>> BatchEncoder::encode(const SectionBytes& sections, double linkNsPerByte) {
    ControlWriter head;
    uint32_t codings = 0;
    for (size_t i = 0; i < kSections; ++i) {
        const auto bytes = sections[i];
        const Coding coding = choices_[i].choose(bytes.size(), linkNsPerByte);
        coded_[i].clear();
        if (coding == Coding::Lz4 || coding == Coding::Zstd) {
            const int64_t beganNs = nowNs_();
            if (!compressors_[i].compress(coding, bytes, coded_[i])) return Error{"the stream can't be compressed: no memory"};
            choices_[i].measured(coding, bytes.size(), coded_[i].size(), nowNs_() - beganNs);
        }
        codings |= static_cast<uint32_t>(coding) << 2 * i;
        if (coding != Coding::Empty) head.number(static_cast<uint32_t>(bytes.size()));
        if (!coded_[i].empty()) head.number(static_cast<uint32_t>(coded_[i].size()));
    }
    out_.assign(1, static_cast<std::byte>(codings));
    out_.insert(out_.end(), head.bytes().begin(), head.bytes().end());
    for (size_t i = 0; i < kSections; ++i) {
        const std::span<const std::byte> bytes = coded_[i].empty() ? sections[i] : coded_[i];
        out_.insert(out_.end(), bytes.begin(), bytes.end());
    }
    return std::span<const std::byte>(out_);
}

Result<SectionBytes> BatchDecoder::decode(std::span<const std::byte> batch) {
    const Error broken{"the head's stream can't be unpacked: a batch of impossible sizes; head and nodes must be of one build"};
    if (batch.empty()) return broken;
    const auto codings = static_cast<uint32_t>(batch[0]);
    ControlReader head(batch.subspan(1));
    std::array<uint32_t, kSections> sizes{}, coded{};
    uint64_t sum = 0, allCoded = 0;
    for (size_t i = 0; i < kSections; ++i) {
        const auto coding = static_cast<Coding>(codings >> 2 * i & 3);
        if (coding == Coding::Empty) continue;
        coded[i] = sizes[i] = head.number();
        if (coding != Coding::Raw) coded[i] = head.number();
        sum += sizes[i];
        allCoded += coded[i];
    }
    // Twice: what is unpacked, and the bytes that say how.
    if (head.bad() || sum > 2 * kMostBatchBytes || allCoded != head.left().size()) return broken;
    auto left = head.left();
    SectionBytes result;
    for (size_t i = 0; i < kSections; ++i) {
        const auto coding = static_cast<Coding>(codings >> 2 * i & 3);
        const auto bytes = left.first(coded[i]);
        left = left.subspan(coded[i]);
        result[i] = bytes;
        if (coding != Coding::Lz4 && coding != Coding::Zstd) continue;
        sections_[i].resize(sizes[i]);
        if (!decompressors_[i].decompress(coding, bytes, sections_[i])) return Error{"the head's stream can't be unpacked: compressed bytes that are none; head and nodes must be of one build"};
        result[i] = sections_[i];
    }
    return result;
}

} // namespace mural::economy
