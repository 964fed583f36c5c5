#include "economy/coding_choice.hpp"

#include <algorithm>
#include <bit>

namespace mural::economy {

namespace {
constexpr double kWeight = 0.2;          // of a new value against all before
constexpr double kFasterWeight = 0.5;    // of a time that is less: what else a machine does makes times longer only
constexpr uint64_t kTryBytes = 1 << 16;  // so much of a section's kind, or
constexpr uint64_t kTrySections = 4;     // so many, show what a coding makes of it
constexpr uint64_t kTryTimes = 3;        // the first pays for memory that is new to the compressor and does not count
constexpr uint64_t kTimedEvery = 16;     // short sections
constexpr uint64_t kLongTimedEvery = 4;
constexpr uint64_t kTryAgainEvery = 256; // sections: what they hold may have changed
constexpr double kClearlySmaller = 0.97; // as small as that is smaller
constexpr double kForSmaller = 1.3;      // so much longer Zstandard may take: the link is everyone's, and what was measured is not exact
constexpr int64_t kWaitedNs = 1'000'000; // a write that took longer has waited for the link
constexpr size_t kLeastLinkBytes = 16384;
} // namespace

Coding CodingChoice::choose(size_t sizeBytes, double linkNsPerByte) {
    if (sizeBytes == 0) return Coding::Empty;
    if (sizeBytes < kLeastBytes) return Coding::Raw;
    ++chosen_;
    constexpr std::array compressed{Coding::Zstd, Coding::Lz4};
    if (!known(Coding::Zstd) || sampleBytes(sizeBytes) != 0) return Coding::Zstd;
    if (!known(Coding::Lz4)) return Coding::Lz4;
    const Coding now = best(linkNsPerByte);
    if (!triesAgain()) return now;
    return now == Coding::Raw ? compressed[tries_++ % compressed.size()] : now == Coding::Zstd ? Coding::Lz4 : Coding::Zstd;
}

Coding CodingChoice::best(double linkNsPerByte) const {
    const Coding fast = cost(Coding::Lz4, linkNsPerByte) < cost(Coding::Raw, linkNsPerByte) ? Coding::Lz4 : Coding::Raw;
    const bool smaller = ratioOf(Coding::Zstd) < kClearlySmaller * ratioOf(fast);
    return cost(Coding::Zstd, linkNsPerByte) < cost(fast, linkNsPerByte) * (smaller ? kForSmaller : 1) ? Coding::Zstd : fast;
}

// Sooner at first: what was measured of few sections may have been disturbed.
bool CodingChoice::triesAgain() const { return chosen_ % kTryAgainEvery == 0 || (chosen_ >= kTimedEvery && chosen_ < kTryAgainEvery && std::has_single_bit(chosen_)); }

bool CodingChoice::known(Coding coding) const {
    const Measured& m = measured_[static_cast<size_t>(coding)];
    return m.times >= kTryTimes && (m.bytes >= kTryBytes || m.sections >= kTrySections);
}

bool CodingChoice::wantsTime(Coding coding, size_t sizeBytes) const { return !known(coding) || chosen_ % (sizeBytes >= kLongBytes ? kLongTimedEvery : kTimedEvery) == 0; }

double CodingChoice::ratio() const { return std::min(measured_[static_cast<size_t>(Coding::Zstd)].ratio, measured_[static_cast<size_t>(Coding::Lz4)].ratio); }

double CodingChoice::cost(Coding coding, double linkNsPerByte) const {
    const Measured& m = measured_[static_cast<size_t>(coding)];
    return coding == Coding::Raw ? linkNsPerByte : m.nsPerByte + m.ratio * linkNsPerByte;
}

void CodingChoice::measured(Coding coding, size_t sizeBytes, size_t codedBytes, std::optional<int64_t> ns) {
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
    if (ns < kWaitedNs || sizeBytes < kLeastLinkBytes) return;
    nsPerByte_ += kWeight * (static_cast<double>(ns) / static_cast<double>(sizeBytes) - nsPerByte_);
}

} // namespace mural::economy
