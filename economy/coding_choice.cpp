#include "economy/coding_choice.hpp"

#include <algorithm>

namespace mural::economy {

namespace {
constexpr double kWeight = 0.2;          // of a new value against all before
constexpr uint64_t kTryBytes = 1 << 16;  // so much of a section's kind shows what a coding makes of it
constexpr uint64_t kTryAgainEvery = 256; // sections: what they hold may have changed
constexpr int64_t kWaitedNs = 1'000'000; // a write that took longer has waited for the link
constexpr size_t kLeastLinkBytes = 16384;
} // namespace

Coding CodingChoice::choose(size_t sizeBytes, double linkNsPerByte) {
    if (sizeBytes == 0) return Coding::Empty;
    if (sizeBytes < kLeastBytes) return Coding::Raw;
    ++chosen_;
    constexpr std::array compressed{Coding::Zstd, Coding::Lz4};
    for (const Coding coding : compressed)
        if (measured_[static_cast<size_t>(coding)].bytes < kTryBytes) return coding;
    if (chosen_ % kTryAgainEvery == 0) return compressed[chosen_ / kTryAgainEvery % compressed.size()];
    Coding best = Coding::Raw;
    for (const Coding coding : compressed)
        if (cost(coding, linkNsPerByte) < cost(best, linkNsPerByte)) best = coding;
    return best;
}

double CodingChoice::ratio() const { return std::min(measured_[static_cast<size_t>(Coding::Zstd)].ratio, measured_[static_cast<size_t>(Coding::Lz4)].ratio); }

double CodingChoice::cost(Coding coding, double linkNsPerByte) const {
    const Measured& m = measured_[static_cast<size_t>(coding)];
    return coding == Coding::Raw ? linkNsPerByte : m.nsPerByte + m.ratio * linkNsPerByte;
}

void CodingChoice::measured(Coding coding, size_t sizeBytes, size_t codedBytes, int64_t ns) {
    if (sizeBytes == 0) return;
    Measured& m = measured_[static_cast<size_t>(coding)];
    const double nsPerByte = static_cast<double>(ns) / static_cast<double>(sizeBytes), ratio = static_cast<double>(codedBytes) / static_cast<double>(sizeBytes);
    const double weight = m.bytes == 0 ? 1 : kWeight;
    m.nsPerByte += weight * (nsPerByte - m.nsPerByte);
    m.ratio += weight * (ratio - m.ratio);
    m.bytes += sizeBytes;
}

void LinkRate::wrote(size_t sizeBytes, int64_t ns) {
    if (ns < kWaitedNs || sizeBytes < kLeastLinkBytes) return;
    nsPerByte_ += kWeight * (static_cast<double>(ns) / static_cast<double>(sizeBytes) - nsPerByte_);
}

} // namespace mural::economy
