#include "compositor/selector/codec_selector.hpp"

#include <algorithm>
#include <cmath>

namespace mural::compositor {

namespace {

constexpr double kNsPerSec = 1e9;
// Of a new report; so that one piece that was interrupted does not turn the choice.
constexpr double kTimeWeight = 0.2;
constexpr double kSizeWeight = 0.4;
constexpr double kLinkWeight = 0.25;
// Sizes are exact: one that is so far from what was expected means that the content is another.
constexpr double kContentChange = 1.5;
constexpr double kLinkChange = 1.5;
// Trying: one piece in so many.
constexpr uint64_t kTryNew = 4;
constexpr uint64_t kTryStale = 8;
constexpr uint64_t kTryAgain = 64;
// What was spent long ago, perhaps over another link, pays for nothing now: per piece.
constexpr double kForget = 1.0 / 256;
// Under Pipelined all three times count a little: of two codecs that the link hides, the cheaper one is taken.
constexpr double kHiddenShare = 1.0 / 64;

double farther(double a, double b) { return std::max(a, b) / std::max(std::min(a, b), 1e-12); }

} // namespace

CodecSelector::CodecSelector(std::vector<std::string> codecs, SelectorOptions options)
    : codecs_(std::move(codecs)), options_(options), linkBytesPerSec_(options.startBytesPerSec) {
    const auto raw = std::ranges::find(codecs_, "raw");
    raw_ = raw == codecs_.end() ? 0 : static_cast<size_t>(raw - codecs_.begin());
}

CodecSelector::ClassState& CodecSelector::stateOf(const TileClass& tile) {
    ClassState& s = classes_[tile];
    if (s.codecs.empty()) {
        s.codecs.resize(codecs_.size());
        s.chosen = raw_;
    }
    return s;
}

double CodecSelector::nsPerByte(const Estimate& e) const {
    const double decode = e.decodeKnown ? e.decodeNsPerByte : e.encodeNsPerByte;
    const double transfer = e.encodedPerByte * kNsPerSec / linkBytesPerSec_;
    const double sum = e.encodeNsPerByte + transfer + decode;
    if (options_.overlap == Overlap::Serial) return sum;
    return std::max({e.encodeNsPerByte, transfer, decode}) + sum * kHiddenShare;
}

size_t CodecSelector::bestOf(const ClassState& s) const {
    size_t best = s.codecs.size();
    for (size_t i = 0; i < s.codecs.size(); ++i) {
        if (s.codecs[i].reports == 0) continue;
        if (best == s.codecs.size() || nsPerByte(s.codecs[i]) < nsPerByte(s.codecs[best])) best = i;
    }
    if (best == s.codecs.size()) return raw_;
    // A measured old value is worth less than a fresh one that is nearly as good.
    if (s.codecs[best].stale && s.codecs[s.chosen].reports > 0 && !s.codecs[s.chosen].stale && nsPerByte(s.codecs[s.chosen]) < 1.1 * nsPerByte(s.codecs[best])) return s.chosen;
    return best;
}

// Another codec than the best that this piece shall be tried with; or the best.
size_t CodecSelector::toTry(const ClassState& s, size_t best, uint64_t rawBytes) const {
    size_t oldest = best;
    for (size_t i = 0; i < s.codecs.size(); ++i) {
        const Estimate& e = s.codecs[i];
        if (i == best) continue;
        if (e.reports == 0) {
            // The first pieces of all must be measured somehow: raw first, it costs the least.
            if (s.pieces % kTryNew == 0 || s.codecs[best].reports == 0) return i;
            continue;
        }
        if (oldest == best || (e.stale && !s.codecs[oldest].stale) || (e.stale == s.codecs[oldest].stale && e.measuredAt < s.codecs[oldest].measuredAt)) oldest = i;
    }
    if (oldest == best || s.pieces % (s.codecs[oldest].stale ? kTryStale : kTryAgain) != 0) return best;
    // One that was much worse is tried seldom: its excess must fit in the share.
    const double excess = std::max(0.0, nsPerByte(s.codecs[oldest]) - nsPerByte(s.codecs[best])) * static_cast<double>(rawBytes);
    return s.exploredNs + excess <= options_.exploreShare * s.spentNs ? oldest : best;
}

size_t CodecSelector::choose(const TileClass& tile, uint64_t rawBytes) {
    ClassState& s = stateOf(tile);
    const size_t best = bestOf(s);
    const size_t tried = toTry(s, best, rawBytes);
    ++s.pieces;
    if (s.codecs[best].reports > 0) {
        s.exploredNs *= 1 - kForget;
        s.spentNs += nsPerByte(s.codecs[best]) * static_cast<double>(rawBytes) - s.spentNs * kForget;
        if (tried != best && s.codecs[tried].reports > 0) s.exploredNs += std::max(0.0, nsPerByte(s.codecs[tried]) - nsPerByte(s.codecs[best])) * static_cast<double>(rawBytes);
    }
    if (tried == best) s.chosen = best;
    return tried;
}

void CodecSelector::encoded(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes, int64_t encodeNs) {
    if (rawBytes == 0 || codec >= codecs_.size()) return;
    ClassState& s = stateOf(tile);
    Estimate& e = s.codecs[codec];
    const double encode = static_cast<double>(std::max<int64_t>(encodeNs, 1)) / static_cast<double>(rawBytes);
    const double size = static_cast<double>(encodedBytes) / static_cast<double>(rawBytes);
    if (e.reports > 0 && !e.stale && farther(size, e.encodedPerByte) > kContentChange && std::abs(size - e.encodedPerByte) > 0.02) {
        for (Estimate& other : s.codecs) other.stale = true;
    }
    if (e.reports == 0 || e.stale) {
        e.encodeNsPerByte = encode;
        e.encodedPerByte = size;
    } else {
        e.encodeNsPerByte += kTimeWeight * (encode - e.encodeNsPerByte);
        e.encodedPerByte += kSizeWeight * (size - e.encodedPerByte);
    }
    ++e.reports;
    e.stale = false;
    e.measuredAt = s.pieces;
}

void CodecSelector::decoded(const TileClass& tile, size_t codec, uint64_t rawBytes, int64_t decodeNs) {
    if (rawBytes == 0 || codec >= codecs_.size()) return;
    Estimate& e = stateOf(tile).codecs[codec];
    const double decode = static_cast<double>(std::max<int64_t>(decodeNs, 1)) / static_cast<double>(rawBytes);
    e.decodeNsPerByte = e.decodeKnown && farther(decode, e.decodeNsPerByte) < 4 ? e.decodeNsPerByte + kTimeWeight * (decode - e.decodeNsPerByte) : decode;
    e.decodeKnown = true;
}

void CodecSelector::transferred(uint64_t bytes, int64_t ns) {
    if (bytes == 0 || ns <= 0) return;
    const double rate = static_cast<double>(bytes) * kNsPerSec / static_cast<double>(ns);
    const bool isFar = farther(rate, linkBytesPerSec_) > kLinkChange;
    // Twice in a row as far off: the link is another one now.
    const bool again = isFar && lastLinkRate_ > 0 && farther(rate, lastLinkRate_) < kLinkChange;
    if (linkReports_++ == 0 || again) linkBytesPerSec_ = rate;
    else linkBytesPerSec_ += kLinkWeight * (rate - linkBytesPerSec_);
    lastLinkRate_ = isFar ? rate : 0;
}

size_t CodecSelector::best(const TileClass& tile) const {
    const auto s = classes_.find(tile);
    return s == classes_.end() ? raw_ : bestOf(s->second);
}

double CodecSelector::expectedNsPerByte(const TileClass& tile, size_t codec) const {
    const auto s = classes_.find(tile);
    return s == classes_.end() || s->second.codecs[codec].reports == 0 ? 0 : nsPerByte(s->second.codecs[codec]);
}

} // namespace mural::compositor
