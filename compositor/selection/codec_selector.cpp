#include "compositor/selection/codec_selector.hpp"

#include <algorithm>
#include <cmath>

namespace mural::compositor {

namespace {

constexpr double kNsPerSec = 1e9;
// Weight of a new report; low, so one interrupted piece does not change the choice.
constexpr double kWeight = 0.1;
constexpr double kMeasuredWeight = 0.7; // higher, because these reports are rare
constexpr double kRecentWeight = 0.3;
constexpr double kLinkWeight = 0.25;
// Ratio between recent and earlier pieces of a class that indicates changed content.
constexpr double kContentChange = 2;
constexpr double kSizeChange = 0.02; // least relevant size change, relative to the raw size
constexpr uint64_t kSettled = 16;    // pieces before the next change is detected
constexpr double kLinkChange = 1.5;
// At most one piece in kMeasureEvery is measured with another codec; usually the time share is the tighter bound.
constexpr uint64_t kMeasureEvery = 3;
constexpr double kStaleShares = 3; // multiple of the time share for stale codecs, which may be best
constexpr double kStaleWorth = 4;
constexpr double kNewAge = 1e6;     // age of an unmeasured codec, in pieces; exceeds all others
constexpr double kCreditPieces = 4; // pieces whose time the first measurement may take
constexpr double kHopefully = 0.5;  // optimistic factor: other content may be this much faster
constexpr double kMaxOff = 4;       // factor above the estimate that marks an outlier, unless it repeats
// Assumed times of an unmeasured codec relative to the best one.
constexpr double kNewEncode = 8, kNewDecode = 4;
// Decay of past expenses per piece.
constexpr double kForget = 1.0 / 1024;
// Pipelined: weight of the hidden times, so the cheaper of two equal codecs wins.
constexpr double kHiddenShare = 1.0 / 64;

double farther(double a, double b) { return std::max(a, b) / std::max(std::min(a, b), 1e-12); }
void approach(double& value, double report, double weight) { value += weight * (report - value); }
double within(double report, double before) {
    return before > 0 ? std::clamp(report, before / kMaxOff, before * kMaxOff) : report;
}
double perByte(int64_t ns, uint64_t rawBytes) {
    return static_cast<double>(std::max<int64_t>(ns, 1)) / static_cast<double>(rawBytes);
}

} // namespace

CodecSelector::CodecSelector(std::vector<std::string> codecs, SelectorOptions options)
    : codecs_(std::move(codecs)), options_(options), linkBytesPerSec_(options.startBytesPerSec) {
    const auto raw = std::ranges::find(codecs_, "raw");
    raw_ = raw == codecs_.end() ? 0 : static_cast<size_t>(raw - codecs_.begin());
}

CodecSelector::ClassState& CodecSelector::stateOf(const TileClass& tile) {
    ClassState& s = classes_[tile];
    s.codecs.resize(codecs_.size());
    return s;
}

double CodecSelector::nsPerByte(const Estimate& e) const {
    const double decode = e.decodeKnown ? e.decodeNsPerByte : e.encodeNsPerByte;
    return totalNsPerByte(e.encodeNsPerByte, e.encodedPerByte * kNsPerSec / linkBytesPerSec_, decode);
}

double CodecSelector::totalNsPerByte(double encode, double transfer, double decode) const {
    const double sum = encode + transfer + decode;
    if (options_.overlap == Overlap::Serial) return sum;
    return std::max({encode, transfer, decode}) + sum * kHiddenShare;
}

// Estimates of this class, or the mean ratio to the best codec in other classes; 0 ns: unknown.
CodecSelector::Times CodecSelector::timesOf(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const {
    const auto times = [](const Estimate& e) {
        return Times{e.encodeNsPerByte, e.decodeKnown ? e.decodeNsPerByte : e.encodeNsPerByte};
    };
    if (s.codecs[codec].reports > 0) return times(s.codecs[codec]);
    Times ratios;
    double classes = 0;
    for (const auto& [tile, state] : classes_) {
        if (tile.format != format || state.codecs.empty() || state.codecs[codec].reports == 0 ||
            state.codecs[best].reports == 0)
            continue;
        const Times there = times(state.codecs[codec]), bestThere = times(state.codecs[best]);
        ratios.encode += there.encode / bestThere.encode;
        ratios.decode += there.decode / bestThere.decode;
        ++classes;
    }
    if (classes == 0) return {};
    const Times here = times(s.codecs[best]);
    return {here.encode * ratios.encode / classes, here.decode * ratios.decode / classes};
}

// Returns true if the codec could not win even with zero output in an optimistic time. Without a codec, pieces keep
// their size.
bool CodecSelector::isHopeless(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const {
    const Times times = timesOf(format, s, codec, best);
    const double transfer = codec == raw_ ? kNsPerSec / linkBytesPerSec_ : 0;
    return totalNsPerByte(times.encode * kHopefully, transfer, times.decode * kHopefully) > nsPerByte(s.codecs[best]);
}

size_t CodecSelector::bestOf(const ClassState& s) const {
    size_t best = s.codecs.size();
    for (size_t i = 0; i < s.codecs.size(); ++i)
        if (s.codecs[i].reports > 0 && (best == s.codecs.size() || nsPerByte(s.codecs[i]) < nsPerByte(s.codecs[best])))
            best = i;
    if (best != s.codecs.size()) return best;
    return raw_ == 0 && s.codecs.size() > 1 ? 1 : 0; // no knowledge: the first codec that compresses
}

// Returns the cost of measuring a codec; a guess for an unmeasured one.
double CodecSelector::measuringNsPerByte(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const {
    if (const Times times = timesOf(format, s, codec, best); times.sum() > 0) return times.sum();
    const Estimate& b = s.codecs[best];
    const double decode = b.decodeKnown ? b.decodeNsPerByte : b.encodeNsPerByte;
    return codec == raw_ ? b.encodeNsPerByte + decode : kNewEncode * b.encodeNsPerByte + kNewDecode * decode;
}

// Returns the value of a measurement: low for codecs far behind, high for stale or new ones.
double CodecSelector::worthMeasuring(PlaneFormat format, const ClassState& s, size_t codec, size_t best) const {
    const Estimate& e = s.codecs[codec];
    const double behind = e.reports > 0 ? nsPerByte(e) / nsPerByte(s.codecs[best]) : 1;
    const double age =
        e.reports > 0 ? static_cast<double>(s.pieces - e.measuredAt) * (e.stale ? kStaleWorth : 1) : kNewAge;
    return age / (measuringNsPerByte(format, s, codec, best) * behind * behind * behind);
}

// Returns the most valuable codec once its cost fits the budget. Cheaper, less valuable measurements would otherwise
// starve it.
std::optional<size_t> CodecSelector::toMeasure(PlaneFormat format, const ClassState& s, size_t best,
                                               uint64_t rawBytes) const {
    // no reference for the first piece
    if (s.codecs[best].reports == 0 || s.pieces % kMeasureEvery != 0) return std::nullopt;
    std::optional<size_t> found;
    double maximum = 0;
    for (size_t i = 0; i < s.codecs.size(); ++i) {
        const double worth = i == best || isHopeless(format, s, i, best) ? 0 : worthMeasuring(format, s, i, best);
        if (worth <= maximum) continue;
        found = i;
        maximum = worth;
    }
    if (!found) return found;
    const Estimate& e = s.codecs[*found];
    const double limitNs = options_.measureShare * (e.stale ? kStaleShares : 1) * s.spentNs;
    // The first measurement may exceed the budget, once for all classes, and once per class where it is cheap.
    const double costNsPerByte = measuringNsPerByte(format, s, *found, best);
    const bool onCredit = e.reports == 0 && (timesOf(format, s, *found, best).sum() == 0 ||
                                             costNsPerByte < kCreditPieces * nsPerByte(s.codecs[best]));
    if (!onCredit && s.measuringNs + costNsPerByte * static_cast<double>(rawBytes) > limitNs) return std::nullopt;
    return found;
}

CodecSelector::Choice CodecSelector::choose(const TileClass& tile, uint64_t rawBytes) {
    ClassState& s = stateOf(tile);
    const size_t best = bestOf(s);
    ++s.pieces;
    if (s.codecs[best].reports > 0) {
        const double pieceNs = nsPerByte(s.codecs[best]) * static_cast<double>(rawBytes);
        // Bounded by the current cost: a slow link or hard content in the past does not raise the budget now.
        s.spentNs = std::min(s.spentNs * (1 - kForget) + pieceNs, pieceNs / kForget);
        s.measuringNs = std::min(s.measuringNs * (1 - kForget), options_.measureShare * s.spentNs);
    }
    const std::optional<size_t> measure = toMeasure(tile.format, s, best, rawBytes);
    if (measure) s.measuringNs += measuringNsPerByte(tile.format, s, *measure, best) * static_cast<double>(rawBytes);
    return {best, measure};
}

// A large change of sizes makes the estimates of all other codecs stale.
void CodecSelector::noticeChange(ClassState& s, Estimate& e) {
    if (s.pieces < s.changedAt + kSettled || farther(e.recentPerByte, e.encodedPerByte) < kContentChange ||
        std::abs(e.recentPerByte - e.encodedPerByte) < kSizeChange)
        return;
    for (Estimate& other : s.codecs) other.stale = true;
    e.stale = false;
    const double before = nsPerByte(e);
    e.encodedPerByte = e.recentPerByte;
    s.changedAt = s.pieces;
    // Scales the budget as if the content had always been like this, which pays for new measurements.
    s.spentNs *= std::max(1.0, nsPerByte(e) / before);
    s.measuringNs = 0;
}

void CodecSelector::encoded(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes,
                            int64_t encodeNs) {
    if (rawBytes == 0 || codec >= codecs_.size()) return;
    ClassState& s = stateOf(tile);
    Estimate& e = s.codecs[codec];
    const double size = static_cast<double>(encodedBytes) / static_cast<double>(rawBytes);
    const double encode = perByte(encodeNs, rawBytes);
    if (e.reports++ == 0) {
        e.encodeNsPerByte = encode;
        e.encodedPerByte = e.recentPerByte = size;
        e.stale = false;
    } else {
        const double before = e.encodedPerByte;
        approach(e.encodeNsPerByte, within(encode, e.encodeNsPerByte), kWeight);
        approach(e.encodedPerByte, size, kWeight);
        approach(e.recentPerByte, size, kRecentWeight);
        noticeChange(s, e);
        // Other codecs, except raw, are assumed to change by the same factor until they are measured.
        for (size_t i = 0; i < s.codecs.size() && codec != raw_ && before > 0; ++i) {
            Estimate& other = s.codecs[i];
            if (i == codec || i == raw_ || other.reports == 0) continue;
            other.encodedPerByte = other.recentPerByte =
                std::min(1.0, other.encodedPerByte * e.encodedPerByte / before);
        }
    }
    e.measuredAt = s.pieces;
    s.used = codec;
    s.usedPerByte = size;
    s.usedEncodeNs = encode;
}

void CodecSelector::decoded(const TileClass& tile, size_t codec, uint64_t rawBytes, int64_t decodeNs) {
    if (rawBytes == 0 || codec >= codecs_.size()) return;
    Estimate& e = stateOf(tile).codecs[codec];
    const double decode = perByte(decodeNs, rawBytes);
    approach(e.decodeNsPerByte, within(decode, e.decodeNsPerByte), e.decodeKnown ? kWeight : 1);
    e.decodeKnown = true;
}

void CodecSelector::measured(const TileClass& tile, size_t codec, uint64_t rawBytes, uint64_t encodedBytes,
                             int64_t encodeNs, int64_t decodeNs) {
    if (rawBytes == 0 || codec >= codecs_.size()) return;
    ClassState& s = stateOf(tile);
    Estimate& e = s.codecs[codec];
    const Estimate& used = s.codecs[s.used];
    // Normalises by the difficulty of this piece, which affects all codecs.
    const double ofSize =
        codec == raw_ || s.used == raw_ || s.usedPerByte <= 0 ? 1 : used.encodedPerByte / s.usedPerByte;
    const double size = std::min(1.1, static_cast<double>(encodedBytes) / static_cast<double>(rawBytes) * ofSize);
    const double ofTime = std::clamp(used.encodeNsPerByte / std::max(s.usedEncodeNs, 1e-9), 0.5, 2.0);
    const double weight = e.reports == 0 || e.stale ? 1 : kMeasuredWeight;
    approach(e.encodeNsPerByte, within(perByte(encodeNs, rawBytes) * ofTime, e.encodeNsPerByte), weight);
    // Nearly empty pieces say little about sizes; other pieces load the link.
    approach(e.encodedPerByte, size,
             weight == 1 ? 1 : weight * std::clamp(s.usedPerByte / std::max(used.encodedPerByte, 1e-9), 0.05, 1.0));
    e.recentPerByte = e.encodedPerByte;
    approach(e.decodeNsPerByte, within(perByte(decodeNs, rawBytes) * ofTime, e.decodeNsPerByte),
             e.decodeKnown ? weight : 1);
    e.decodeKnown = true;
    e.stale = false;
    ++e.reports;
    e.measuredAt = s.pieces;
}

void CodecSelector::transferred(uint64_t bytes, int64_t ns) {
    if (bytes == 0 || ns <= 0) return;
    const double rate = static_cast<double>(bytes) * kNsPerSec / static_cast<double>(ns);
    const bool isFar = farther(rate, linkBytesPerSec_) > kLinkChange;
    // Two consecutive outliers of equal size: the link has changed.
    const bool again = isFar && lastLinkRate_ > 0 && farther(rate, lastLinkRate_) < kLinkChange;
    lastLinkRate_ = isFar ? rate : 0;
    if (linkReports_++ == 0 || again)
        linkBytesPerSec_ = rate;
    else
        approach(linkBytesPerSec_, rate, kLinkWeight);
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
