#include "streamcodec/delta/batch_codec.hpp"

#include "streamcodec/delta/limits.hpp"
#include "streamcodec/delta/varint.hpp"

namespace mural::delta {
namespace {

constexpr size_t kFirst = 1; // first section after Control
constexpr auto kPages = static_cast<size_t>(Section::Pages);

} // namespace

Result<std::span<const std::byte>> BatchEncoder::encode(const SectionBytes& sections, double linkNsPerByte,
                                                        bool plain) {
    const auto control = sections[static_cast<size_t>(Section::Control)];
    bool others = false;
    for (size_t i = kFirst; i < kSections; ++i) others = others || !sections[i].empty();
    body_.clear();
    if (others) {
        const auto encoded = encodeSections(sections, linkNsPerByte, plain);
        if (!encoded) return encoded.error();
    }
    out_.clear();
    putBatchHead({static_cast<uint32_t>(body_.size() + control.size()), others}, out_);
    out_.insert(out_.end(), body_.begin(), body_.end());
    out_.insert(out_.end(), control.begin(), control.end());
    return std::span<const std::byte>(out_);
}

Result<void> BatchEncoder::encodeSections(const SectionBytes& sections, double linkNsPerByte, bool plain) {
    uint32_t codings = 0;
    body_.assign(1, std::byte{0});
    for (size_t i = kFirst; i < kSections; ++i) {
        const auto bytes = sections[i];
        const bool frames =
            plain && i == static_cast<size_t>(Section::Texts) && bytes.size() >= SectionCodecSelector::kMinBytes;
        const Coding coding = frames ? Coding::Zstd : choices_[i].choose(bytes.size(), linkNsPerByte);
        coded_[i].clear();
        if (coding == Coding::Lz4 || coding == Coding::Zstd) {
            const bool timed = !frames && choices_[i].wantsTime(coding, bytes.size());
            const int64_t beganNs = timed ? nowNs_(bytes.size()) : 0;
            if (!compress(i, coding, bytes)) return Error{"cannot compress the stream: no memory"};
            if (!frames)
                choices_[i].measured(coding, bytes.size(), coded_[i].size(),
                                     timed ? std::optional(nowNs_(bytes.size()) - beganNs) : std::nullopt);
        }
        if (const size_t sample = choices_[i].sampleBytes(bytes.size()); sample != 0) {
            const int64_t beganNs = nowNs_(sample);
            const size_t codedBytes = lz4Bytes(bytes.first(sample), scratch_);
            choices_[i].measured(Coding::Lz4, sample, codedBytes, nowNs_(sample) - beganNs);
        }
        codings |= static_cast<uint32_t>(coding) << 2 * (i - kFirst);
        if (coding != Coding::Empty) writeVarint(bytes.size(), body_);
        if (!coded_[i].empty()) writeVarint(coded_[i].size(), body_);
    }
    body_[0] = static_cast<std::byte>(codings);
    for (size_t i = kFirst; i < kSections; ++i) {
        const std::span<const std::byte> bytes = coded_[i].empty() ? sections[i] : coded_[i];
        body_.insert(body_.end(), bytes.begin(), bytes.end());
    }
    return {};
}

bool BatchEncoder::compress(size_t section, Coding coding, std::span<const std::byte> bytes) {
    auto& into = coded_[section];
    return section == kPages ? pages_.compress(coding, bytes, into)
                             : compressors_[section].compress(coding, bytes, into);
}

bool BatchDecoder::decompress(size_t section, Coding coding, std::span<const std::byte> bytes) {
    auto& into = sections_[section];
    return section == kPages ? pages_.decompress(coding, bytes, into)
                             : decompressors_[section].decompress(coding, bytes, into);
}

Result<SectionBytes> BatchDecoder::decode(BatchHead head, std::span<const std::byte> body) {
    const Error broken{"cannot decode the head's stream: a batch has invalid sizes; install the same version of mural "
                       "on all machines"};
    SectionBytes result;
    auto left = body;
    if (head.sections) {
        if (left.empty()) return broken;
        const auto codings = static_cast<uint32_t>(left[0]);
        left = left.subspan(1);
        const auto codingOf = [&](size_t i) { return static_cast<Coding>(codings >> 2 * (i - kFirst) & 3); };
        std::array<uint32_t, kSections> sizes{}, coded{};
        uint64_t sum = 0, allCoded = 0;
        for (size_t i = kFirst; i < kSections; ++i) {
            if (codingOf(i) == Coding::Empty) continue;
            if (!readVarint(left, sizes[i])) return broken;
            coded[i] = sizes[i];
            if (codingOf(i) != Coding::Raw && !readVarint(left, coded[i])) return broken;
            sum += sizes[i];
            allCoded += coded[i];
        }
        if (sum > kMaxBatchBytes || allCoded > left.size()) return broken;
        for (size_t i = kFirst; i < kSections; ++i) {
            const auto bytes = left.first(coded[i]);
            left = left.subspan(coded[i]);
            result[i] = bytes;
            if (codingOf(i) != Coding::Lz4 && codingOf(i) != Coding::Zstd) continue;
            sections_[i].resize(sizes[i]);
            if (!decompress(i, codingOf(i), bytes))
                return Error{"cannot decode the head's stream: invalid compressed data; install the same version of "
                             "mural on all machines"};
            result[i] = sections_[i];
        }
    }
    result[static_cast<size_t>(Section::Control)] = left;
    return result;
}

} // namespace mural::delta
