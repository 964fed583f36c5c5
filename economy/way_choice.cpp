#include "economy/way_choice.hpp"

#include <algorithm>
#include <utility>

namespace mural::economy {

namespace {
constexpr double kKept = 0.8;              // of all before, when a batch is added
constexpr uint32_t kTryBatches = 5;
constexpr uint32_t kUnmeasured = 2;        // of them: what was remembered by this way is from long ago
constexpr uint32_t kCompared = kTryBatches - kUnmeasured;
constexpr double kHopeless = 2;            // a try that costs so many times what it is compared with, ends at once
constexpr double kTryPart = 50;            // of the time of batches, one is what tries may take of it
constexpr uint32_t kLeastBetween = 16;     // batches between two tries
constexpr uint32_t kMeasuredEvery = 8;     // batches between two tries
constexpr uint32_t kCheapEvery = 64;       // of batches that cost not much more than the clock
constexpr double kClearly = 0.95;          // as small as that is cheaper
constexpr double kWorthNs = 20'000;        // of a frame that is looked at in less, bytes count more than the time…
constexpr double kTooDear = 1.9;           // …unless plain it takes so many times less
constexpr double kCheapNs = 5'000;         // a frame that is looked at in less is not worth a try
constexpr double kRepeats = 1.0 / 100;     // what plain comes to so few bytes is the same each time
constexpr double kDear = 3;                // a byte that is looked at takes so many times what a new one does
constexpr double kMuch = 2;                // a change of cost that asks for another try
// Nodes unpack it before they draw: so long beside packing, looked at and plain (measured: 0.5 to 0.75 and 0.25 to 0.35).
constexpr std::array<double, 2> kWithUnpacking{1.6, 1.3};
} // namespace

bool WayChoice::wantsTime() const { return trying_ || batches_ + 1 + kCompared >= until_ || batches_ % (cheap_ ? kCheapEvery : kMeasuredEvery) == 0; }

void WayChoice::measured(uint64_t rawBytes, uint64_t pageBytes, uint64_t wireBytes, int64_t ns, double linkNsPerByte) {
    ++batches_;
    if (std::exchange(isFirst_, false) && rawBytes > 0) firstNsPerByte_ = static_cast<double>(ns) / static_cast<double>(rawBytes);
    if (trying_ && batches_ < kUnmeasured) return;
    Cost& cost = costs_[plain_ ? Plain : Looked];
    const bool isAboutShort = pageBytes < rawBytes / 2; // else there is little to win, and places of pages to lose
    const bool isDear = isAboutShort && isDearAtOnce(rawBytes, ns);
    if (isDear) {
        cost = {}; // new bytes say nothing of what looking costs
        until_ = batches_;
        isByOne_ = true;
    }
    if (!trying_ && batches_ + kCompared == until_) cost = {}; // compared is what comes just before with what comes just behind
    cost.ns = cost.ns * kKept + static_cast<double>(ns) * kWithUnpacking[plain_ ? Plain : Looked] + static_cast<double>(wireBytes) * linkNsPerByte;
    cost.rawBytes = cost.rawBytes * kKept + static_cast<double>(rawBytes);
    cost.wireBytes = cost.wireBytes * kKept + static_cast<double>(wireBytes);
    cost.encodeNs = cost.encodeNs * kKept + static_cast<double>(ns);
    cost.leastNs = cost.batches == 0 ? static_cast<double>(ns) : std::min(cost.leastNs, static_cast<double>(ns));
    cost.batches = cost.batches * kKept + 1;
    cheap_ = cost.leastNs < kCheapNs;
    if (trying_) {
        const bool hopeless = cost.perByte() > costs_[plain_ ? Looked : Plain].perByte() * kHopeless;
        if (batches_ >= kTryBatches || hopeless) decide();
        else if (batches_ == kUnmeasured) cost = {};
        return;
    }
    const double now = cost.perByte();
    const bool another = decidedBy_ > 0 && batches_ >= kLeastBetween && (now > decidedBy_ * kMuch || now * kMuch < decidedBy_);
    if (another && until_ > batches_ + kCompared) {
        until_ = batches_ + kCompared;
        cost = {};
        return;
    }
    if (batches_ < until_) return;
    if (std::exchange(isByLeftOut_, false) && cost.wireBytes > cost.rawBytes * kRepeats) {
        until_ = kLeastBetween * 8;
        return;
    }
    if (plain_ || (isAboutShort && cost.leastNs >= kCheapNs)) tryOther();
    else until_ += cheap_ ? kCheapEvery * 2 : kLeastBetween;
}

// Of the second batch, and the next, before there was a try: to wait for that would cost more than it tells.
bool WayChoice::isDearAtOnce(uint64_t rawBytes, int64_t ns) const {
    const bool isEarly = !plain_ && !trying_ && costs_[Plain].batches == 0 && batches_ > 1 && batches_ < until_ && firstNsPerByte_ > 0;
    return isEarly && static_cast<double>(ns) >= kWorthNs && static_cast<double>(ns) > static_cast<double>(rawBytes) * firstNsPerByte_ * kDear;
}

void WayChoice::leftOut() {
    if (std::exchange(isFirst_, false)) return; // all is new
    until_ = trying_ ? std::min(std::max(until_ * 2, kLeastBetween), kMostBetween) : kLeastBetween;
    isByLeftOut_ = !trying_;
    plain_ = true;
    trying_ = false;
    batches_ = 0;
    costs_[Plain] = {};
    decidedBy_ = 0;
}

void WayChoice::tryOther() {
    plain_ = !plain_;
    trying_ = true;
    batches_ = 0;
    costs_[plain_ ? Plain : Looked] = {};
}

void WayChoice::decide() {
    const double tried = costs_[plain_ ? Plain : Looked].perByte(), before = costs_[plain_ ? Looked : Plain].perByte();
    const Cost &looked = costs_[Looked], &asItIs = costs_[Plain];
    const bool isSmall = looked.leastNs < kWorthNs;
    const bool tooDear = looked.leastNs > asItIs.leastNs * kTooDear; // one that something else has disturbed decides nothing
    const bool better = isSmall ? plain_ == tooDear : tried < before * kClearly;
    if (!better) plain_ = !plain_;
    // What a try takes more than the way that is kept, is a small part of what comes before the next.
    const double more = (plain_ ? looked : asItIs).leastNs / std::max((plain_ ? asItIs : looked).leastNs, 1.0) - 1;
    const double least = better ? kLeastBetween * 8 : std::max(until_ * 2, kLeastBetween);
    until_ = static_cast<uint32_t>(std::min(std::max(more * kTryBatches * kTryPart, least), double{kMostBetween}));
    if (std::exchange(isByOne_, false) && plain_) until_ = kLeastBetween * 8;
    decidedBy_ = std::min(tried, before);
    trying_ = false;
    batches_ = 0;
}

} // namespace mural::economy
