#include "streamcodec/delta/entropy/section_codec_selector.hpp"

#include <algorithm>
#include <bit>

namespace mural::delta {

namespace {
constexpr double kWeight = 0.2;         // weight of a new value in the moving average
constexpr double kFasterWeight = 0.5;   // weight of a shorter time: other load on the machine only lengthens times
constexpr uint64_t kTryBytes = 1 << 16; // bytes of a section kind after which a coding is known, or
constexpr uint64_t kTrySections = 4;    // number of sections
constexpr uint64_t kTryTimes = 3;       // the first includes page faults of the compressor's memory and does not count
constexpr uint64_t kTimedEvery = 16;    // short sections between two timings
constexpr uint64_t kLongTimedEvery = 4;
constexpr uint64_t kTryAgainEvery = 256; // sections after which the contents may have changed
constexpr double kClearlySmaller = 0.97; // relative size that counts as smaller
// Zstandard may take longer by this factor: the link is shared, and measurements are inexact
constexpr double kForSmaller = 1.3;
constexpr int64_t kWaitedNs = 1'000'000; // a longer write has waited for the link
constexpr size_t kMinLinkBytes = 16384;
} // namespace

Coding SectionCodecSelector::choose(size_t sizeBytes, double linkNsPerByte) {
    if (sizeBytes == 0) return Coding::Empty;
    if (sizeBytes < kMinBytes) return Coding::Raw;
    ++chosen_;
    constexpr std::array compressed{Coding::Zstd, Coding::Lz4};
    if (!known(Coding::Zstd) || sampleBytes(sizeBytes) != 0) return Coding::Zstd;
    if (!known(Coding::Lz4)) return Coding::Lz4;
    const Coding now = best(linkNsPerByte);
    if (!triesAgain()) return now;
    return now == Coding::Raw    ? compressed[tries_++ % compressed.size()]
           : now == Coding::Zstd ? Coding::Lz4
                                 : Coding::Zstd;
}

Coding SectionCodecSelector::best(double linkNsPerByte) const {
    const Coding fast = cost(Coding::Lz4, linkNsPerByte) < cost(Coding::Raw, linkNsPerByte) ? Coding::Lz4 : Coding::Raw;
    const bool smaller = ratioOf(Coding::Zstd) < kClearlySmaller * ratioOf(fast);
    return cost(Coding::Zstd, linkNsPerByte) < cost(fast, linkNsPerByte) * (smaller ? kForSmaller : 1) ? Coding::Zstd
                                                                                                       : fast;
}

// Retries sooner at first, because few measurements may be disturbed.
bool SectionCodecSelector::triesAgain() const {
    return chosen_ % kTryAgainEvery == 0 ||
           (chosen_ >= kTimedEvery && chosen_ < kTryAgainEvery && std::has_single_bit(chosen_));
}

bool SectionCodecSelector::known(Coding coding) const {
    const Measured& m = measured_[static_cast<size_t>(coding)];
    return m.times >= kTryTimes && (m.bytes >= kTryBytes || m.sections >= kTrySections);
}

bool SectionCodecSelector::wantsTime(Coding coding, size_t sizeBytes) const {
    return !known(coding) || chosen_ % (sizeBytes >= kLongBytes ? kLongTimedEvery : kTimedEvery) == 0;
}

double SectionCodecSelector::ratio() const {
    return std::min(measured_[static_cast<size_t>(Coding::Zstd)].ratio,
                    measured_[static_cast<size_t>(Coding::Lz4)].ratio);
}

double SectionCodecSelector::cost(Coding coding, double linkNsPerByte) const {
    const Measured& m = measured_[static_cast<size_t>(coding)];
    return coding == Coding::Raw ? linkNsPerByte : m.nsPerByte + m.ratio * linkNsPerByte;
}

void SectionCodecSelector::measured(Coding coding, size_t sizeBytes, size_t codedBytes, std::optional<int64_t> ns) {
    if (sizeBytes == 0) return;
    Measured& m = measured_[static_cast<size_t>(coding)];
    const auto each = [sizeBytes](auto n) { return static_cast<double>(n) / static_cast<double>(sizeBytes); };
    const double weight = m.bytes == 0 ? 1 : kWeight;
    if (ns) {
        const double more = each(*ns) - m.nsPerByte;
        m.nsPerByte += more * (++m.times < kTryTimes ? 1 : more < 0 ? kFasterWeight : kWeight);
    }
    m.ratio += weight * (each(codedBytes) - m.ratio);
    m.bytes += sizeBytes;
    ++m.sections;
}

void LinkRate::wrote(size_t sizeBytes, int64_t ns) {
    if (ns < kWaitedNs || sizeBytes < kMinLinkBytes) return;
    nsPerByte_ += kWeight * (static_cast<double>(ns) / static_cast<double>(sizeBytes) - nsPerByte_);
}

} // namespace mural::delta
