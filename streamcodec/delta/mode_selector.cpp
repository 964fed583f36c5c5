#include "streamcodec/delta/mode_selector.hpp"

#include <algorithm>
#include <utility>

namespace mural::delta {

namespace {
constexpr double kAverageWeight = 0.8; // weight of the previous average when a batch is added
constexpr uint32_t kTryBatches = 5;
constexpr uint32_t kUnmeasured = 2; // first batches of a trial, whose dictionary state is outdated
constexpr uint32_t kCompared = kTryBatches - kUnmeasured;
constexpr double kHopeless = 2;        // cost ratio at which a trial ends immediately
constexpr double kTryPart = 50;        // trials take at most 1/kTryPart of the time
constexpr uint32_t kMinBetween = 16;   // batches between two trials
constexpr uint32_t kMeasuredEvery = 8; // batches between two measurements
constexpr uint32_t kCheapEvery = 64;   // the same for batches that cost little more than the clock
constexpr double kClearly = 0.95;      // cost ratio that counts as cheaper
constexpr double kWorthNs = 20'000;    // below this coding time bytes count more than time
constexpr double kTooDear = 1.9;       // unless plain mode is faster by this factor
constexpr double kCheapNs = 5'000;     // below this coding time a trial is pointless
constexpr double kRepeats = 1.0 / 100; // plain output below this fraction shows repeating frames
constexpr double kDear = 3;            // factor between the cost of a coded byte and of a new one
constexpr double kMuch = 2;            // change of the cost that triggers another trial
// Cost including decoding, which delays the drawing of nodes, relative to encoding: delta mode, plain mode (measured:
// 0.5 to 0.75 and 0.25 to 0.35).
constexpr std::array<double, 2> kWithUnpacking{1.6, 1.3};
} // namespace

bool ModeSelector::wantsTime() const {
    return trying_ || batches_ + 1 + kCompared >= until_ || batches_ % (cheap_ ? kCheapEvery : kMeasuredEvery) == 0;
}

void ModeSelector::measured(uint64_t rawBytes, uint64_t pageBytes, uint64_t wireBytes, int64_t ns,
                            double linkNsPerByte) {
    ++batches_;
    if (std::exchange(isFirst_, false) && rawBytes > 0)
        firstNsPerByte_ = static_cast<double>(ns) / static_cast<double>(rawBytes);
    if (trying_ && batches_ < kUnmeasured) return;
    Cost& cost = costs_[plain_ ? Plain : Dictionary];
    const bool isAboutShort = pageBytes < rawBytes / 2; // otherwise the gain is small and page positions would be lost
    const bool isDear = isAboutShort && isDearAtOnce(rawBytes, ns);
    if (isDear) {
        cost = {}; // new bytes do not reveal the cost of delta mode
        until_ = batches_;
        isByOne_ = true;
    }
    // compare batches just before with batches just after the switch
    if (!trying_ && batches_ + kCompared == until_) cost = {};
    cost.ns = cost.ns * kAverageWeight + static_cast<double>(ns) * kWithUnpacking[plain_ ? Plain : Dictionary] +
              static_cast<double>(wireBytes) * linkNsPerByte;
    cost.rawBytes = cost.rawBytes * kAverageWeight + static_cast<double>(rawBytes);
    cost.wireBytes = cost.wireBytes * kAverageWeight + static_cast<double>(wireBytes);
    cost.encodeNs = cost.encodeNs * kAverageWeight + static_cast<double>(ns);
    cost.minNs = cost.batches == 0 ? static_cast<double>(ns) : std::min(cost.minNs, static_cast<double>(ns));
    cost.batches = cost.batches * kAverageWeight + 1;
    cheap_ = cost.minNs < kCheapNs;
    if (trying_) {
        const bool hopeless = cost.perByte() > costs_[plain_ ? Dictionary : Plain].perByte() * kHopeless;
        if (batches_ >= kTryBatches || hopeless)
            decide();
        else if (batches_ == kUnmeasured)
            cost = {};
        return;
    }
    const double now = cost.perByte();
    const bool another =
        decidedBy_ > 0 && batches_ >= kMinBetween && (now > decidedBy_ * kMuch || now * kMuch < decidedBy_);
    if (another && until_ > batches_ + kCompared) {
        until_ = batches_ + kCompared;
        cost = {};
        return;
    }
    if (batches_ < until_) return;
    if (std::exchange(isByLeftOut_, false) && cost.wireBytes > cost.rawBytes * kRepeats) {
        until_ = kMinBetween * 8;
        return;
    }
    if (plain_ || (isAboutShort && cost.minNs >= kCheapNs))
        tryOther();
    else
        until_ += cheap_ ? kCheapEvery * 2 : kMinBetween;
}

// Detects an expensive stream in its second and third batch: waiting for the first trial would cost more than it
// reveals.
bool ModeSelector::isDearAtOnce(uint64_t rawBytes, int64_t ns) const {
    const bool isEarly =
        !plain_ && !trying_ && costs_[Plain].batches == 0 && batches_ > 1 && batches_ < until_ && firstNsPerByte_ > 0;
    return isEarly && static_cast<double>(ns) >= kWorthNs &&
           static_cast<double>(ns) > static_cast<double>(rawBytes) * firstNsPerByte_ * kDear;
}

void ModeSelector::mostlyPlain() {
    if (std::exchange(isFirst_, false)) return; // everything is new
    until_ = trying_ ? std::min(std::max(until_ * 2, kMinBetween), kMaxBetween) : kMinBetween;
    isByLeftOut_ = !trying_;
    plain_ = true;
    trying_ = false;
    batches_ = 0;
    costs_[Plain] = {};
    decidedBy_ = 0;
}

void ModeSelector::tryOther() {
    plain_ = !plain_;
    trying_ = true;
    batches_ = 0;
    costs_[plain_ ? Plain : Dictionary] = {};
}

void ModeSelector::decide() {
    const double tried = costs_[plain_ ? Plain : Dictionary].perByte(),
                 before = costs_[plain_ ? Dictionary : Plain].perByte();
    const Cost &dictionary = costs_[Dictionary], &plain = costs_[Plain];
    const bool isSmall = dictionary.minNs < kWorthNs;
    const bool tooDear = dictionary.minNs > plain.minNs * kTooDear; // one disturbed batch does not decide
    const bool better = isSmall ? plain_ == tooDear : tried < before * kClearly;
    if (!better) plain_ = !plain_;
    // Schedule the next trial so that its overhead stays below 1/kTryPart of the interval.
    const double more = (plain_ ? dictionary : plain).minNs / std::max((plain_ ? plain : dictionary).minNs, 1.0) - 1;
    const double minimum = better ? kMinBetween * 8 : std::max(until_ * 2, kMinBetween);
    until_ = static_cast<uint32_t>(std::min(std::max(more * kTryBatches * kTryPart, minimum), double{kMaxBetween}));
    if (std::exchange(isByOne_, false) && plain_) until_ = kMinBetween * 8;
    decidedBy_ = std::min(tried, before);
    trying_ = false;
    batches_ = 0;
}

} // namespace mural::delta
