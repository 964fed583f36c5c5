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
constexpr double kSizeChange = 0.02; // of the raw size: what small pieces do does not matter
constexpr double kLinkChange = 1.5;
// Trying: one piece in so many.
constexpr uint64_t kTryNew = 4;
constexpr uint64_t kTryStale = 8;
constexpr uint64_t kTryAgain = 64;
constexpr double kStaleShares = 5;
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

// Another codec than the best that this piece shall be tried with; or the best. Of those whose excess can be paid, what is
// stale comes first, and then what was measured longest ago.
size_t CodecSelector::toTry(const ClassState& s, size_t best, uint64_t rawBytes) const {
    size_t tried = best;
    for (size_t i = 0; i < s.codecs.size(); ++i) {
        const Estimate& e = s.codecs[i];
        if (i == best) continue;
        if (e.reports == 0) {
            // How large raw pieces are is known: over a slow link they are not even tried.
            if (i == raw_ && s.codecs[best].reports > 0 && kNsPerSec / linkBytesPerSec_ > nsPerByte(s.codecs[best])) continue;
            if (s.pieces % kTryNew == 0 || s.codecs[best].reports == 0) return i;
            continue;
        }
        // What is stale may be as cheap as any: more is risked for it.
        const double excess = std::max(0.0, nsPerByte(e) - nsPerByte(s.codecs[best])) * static_cast<double>(rawBytes);
        if (s.exploredNs + excess > options_.exploreShare * s.spentNs * (e.stale ? kStaleShares : 1)) continue;
        const Estimate& other = s.codecs[tried];
        if (tried == best || (e.stale && !other.stale) || (e.stale == other.stale && e.measuredAt < other.measuredAt)) tried = i;
    }
    return tried != best && s.pieces % (s.codecs[tried].stale ? kTryStale : kTryAgain) == 0 ? tried : best;
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
    const double expected = nsPerByte(e);
    const bool isOther = e.reports > 0 && !e.stale && farther(size, e.encodedPerByte) > kContentChange && std::abs(size - e.encodedPerByte) > kSizeChange;
    if (isOther)
        for (Estimate& other : s.codecs) other.stale = true;
    if (e.reports == 0 || e.stale) {
        e.encodeNsPerByte = encode;
        e.encodedPerByte = size;
    } else {
        e.encodeNsPerByte += kTimeWeight * (encode - e.encodeNsPerByte);
        e.encodedPerByte += kSizeWeight * (size - e.encodedPerByte);
    }
    if (isOther) { // as if it had always been so: that pays for trying the others
        s.spentNs *= nsPerByte(e) / expected;
        s.exploredNs = 0;
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
    const double measured = linkReports_++ == 0 || again ? rate : linkBytesPerSec_ + kLinkWeight * (rate - linkBytesPerSec_);
    // What pieces took over the old link is no measure for what may be spent over this one.
    std::vector<double> before;
    for (const auto& [tile, s] : classes_) before.push_back(nsPerByte(s.codecs[s.chosen]));
    linkBytesPerSec_ = measured;
    auto old = before.begin();
    for (auto& [tile, s] : classes_) {
        const double change = nsPerByte(s.codecs[s.chosen]) / *old++;
        s.spentNs *= change;
        s.exploredNs *= change;
    }
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
