#include "streamcodec/delta/entropy/word_predictor.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace mural::delta {

namespace {

// Maps values to integers in the order of their values, floats and integers alike. Bijective.
uint32_t ordered(uint32_t word) { return word >> 31 != 0 ? ~word : word | 0x80000000; }
uint32_t wordOf(uint32_t number) { return number >> 31 != 0 ? number & 0x7fffffff : ~number; }

uint32_t exponentOf(uint32_t word) { return word >> 23 & 255; }
// Floats used in arithmetic: normal and far from the limits, or 0.
bool isPlain(uint32_t word) { return (word << 1) == 0 || (exponentOf(word) > 40 && exponentOf(word) < 200); }
double floatOf(uint32_t word) { return static_cast<double>(std::bit_cast<float>(word)); }
uint32_t wordOf(double value) {
    constexpr double kMax = 1e30, kMin = 1e-30;
    if (!(std::abs(value) < kMax)) return 0x7f000000;
    return std::abs(value) < kMin ? 0 : std::bit_cast<uint32_t>(static_cast<float>(value));
}
// Returns the distance between adjacent floats.
double stepAt(uint32_t word) { return std::bit_cast<double>(uint64_t{exponentOf(word) + 1023 - 127 - 23} << 52); }

// Zigzag mapping: small results for small distances of either sign. Bijective.
uint32_t folded(uint32_t distance) { return distance << 1 ^ (0 - (distance >> 31)); }
uint32_t unfolded(uint32_t number) { return number >> 1 ^ (0 - (number & 1)); }
uint32_t widthOf(uint32_t number) { return static_cast<uint32_t>(std::bit_width(number)); }

// Symbols for bit widths. Rare large widths share symbols.
struct Widths {
    uint8_t minimum = 0;
    uint8_t bits = 0; // additional bits that select the width
};
constexpr std::array<Widths, SymbolModel::kSymbols> kWidths{{{0, 0},
                                                             {1, 0},
                                                             {2, 0},
                                                             {3, 0},
                                                             {4, 0},
                                                             {5, 0},
                                                             {6, 0},
                                                             {7, 0},
                                                             {8, 0},
                                                             {9, 0},
                                                             {10, 0},
                                                             {11, 1},
                                                             {13, 2},
                                                             {17, 2},
                                                             {21, 2},
                                                             {25, 3}}};
constexpr auto kSymbolOfWidth = [] {
    std::array<uint8_t, 33> symbols{};
    for (size_t s = 0; s < kWidths.size(); ++s)
        for (uint32_t w = kWidths[s].minimum; w < symbols.size(); ++w) symbols[w] = static_cast<uint8_t>(s);
    return symbols;
}();

} // namespace

void WordPredictor::begin(DictionaryEntry& item, std::span<const std::byte> bytes) {
    item_ = &models_.open(item, bytes);
    if (item_->round == round_) { // the entry repeats: another frame
        ++round_;
        speed_ = 1;
        weight_ = 0;
    }
    item_->round = round_;
    word_ = &models_.word(*item_, 0);
    bendShare_ = 1 / (1 + 1 / item_->speed);
}

void WordPredictor::end() { item_->speed = weight_ > 0 ? speed_ : 1; }

// Extrapolates. Time steps: the last is 1, the one before 1 / item_->speed, the next speed_.
WordPredictor::Curve WordPredictor::prediction(const WordState& word, uint32_t old, Guesses& predictions) const {
    Curve curve;
    predictions[static_cast<size_t>(Prediction::Same)] = old;
    predictions[static_cast<size_t>(Prediction::IntegerLine)] = old + (old - word.before);
    uint32_t& line = predictions[static_cast<size_t>(Prediction::FloatLine)];
    uint32_t& bent = predictions[static_cast<size_t>(Prediction::FloatCurve)];
    line = bent = old;
    if (isPlain(old) && isPlain(word.before) && isPlain(word.twoBefore) && old != word.before) {
        const double last = floatOf(old), step = last - floatOf(word.before),
                     stepBefore = (floatOf(word.before) - floatOf(word.twoBefore)) * item_->speed;
        const double bend = (step - stepBefore) * bendShare_;
        line = wordOf(last + step * speed_);
        curve.value = last + step * speed_ + bend * speed_ * (speed_ + 1);
        curve.slope = step + bend * (2 * speed_ + 1);
        curve.known = true;
        bent = wordOf(curve.value);
    }
    uint32_t& other = predictions[static_cast<size_t>(Prediction::OtherWord)];
    other = word.other == 0 ? old : recent_[(recentEnd_ - word.other) % kRecent] ^ (word.negated ? 0x80000000 : 0);
    return curve;
}

template <class Coder> uint32_t WordPredictor::code(Coder& coder, uint32_t i, uint32_t old, uint32_t now) {
    WordState& word = word_[i];
    Guesses predictions;
    const Curve curve = prediction(word, old, predictions);
    size_t best = 0;
    for (size_t g = 1; g < kPredictions; ++g)
        if (word.cost[g] < word.cost[best]) best = g;
    const uint32_t expected = ordered(predictions[best]);
    const uint32_t distance =
        codeDistance(coder, std::min<uint32_t>(word.cost[best] / 7u, kContexts - 1), ordered(now) - expected);
    const uint32_t value = wordOf(expected + distance);
    update(word, value, predictions, curve);
    word.twoBefore = word.before;
    word.before = old;
    return value;
}

// Codes the bit width of the folded distance, then the bits below the highest.
template <class Coder> uint32_t WordPredictor::codeDistance(Coder& coder, uint32_t context, uint32_t distance) {
    uint32_t number = folded(distance), width = widthOf(number);
    const uint32_t symbol = coder.code(widths_[context], uint32_t{kSymbolOfWidth[width]});
    const Widths widths = kWidths[symbol];
    if (widths.bits > 0)
        width = widths.minimum + coder.code((width - widths.minimum) & 7, unsigned{widths.bits});
    else
        width = widths.minimum;
    if (width <= 1) return unfolded(width);
    uint32_t value = 1;
    for (unsigned bits = std::min(width, 32u) - 1; bits > 0;) {
        const unsigned part = std::min(bits, 16u);
        bits -= part;
        value = value << part | coder.code(number >> bits & ((1u << part) - 1), part);
    }
    return unfolded(value);
}

void WordPredictor::update(WordState& word, uint32_t value, const Guesses& predictions, const Curve& curve) {
    uint32_t minimum = UINT32_MAX;
    for (size_t g = 0; g < kPredictions; ++g) {
        const uint32_t bits = widthOf(folded(ordered(value) - ordered(predictions[g])));
        word.cost[g] = static_cast<uint8_t>((word.cost[g] * 3u + bits * 4 + 2) / 4);
        if (g != static_cast<size_t>(Prediction::OtherWord)) minimum = std::min(minimum, bits);
    }
    // A smoothly moving word reveals the time step; faster words are more precise.
    constexpr uint32_t kGain = 8;
    const uint32_t curved = word.cost[static_cast<size_t>(Prediction::FloatCurve)];
    if (curve.known && curved + kGain <= word.cost[static_cast<size_t>(Prediction::Same)] && isPlain(value) &&
        curve.slope != 0) {
        const double share = curve.slope / stepAt(value), weight = share * share;
        const double speed = speed_ + (floatOf(value) - curve.value) / curve.slope * (weight / (weight_ + weight));
        if (speed > 0.05 && speed < 20) {
            speed_ = speed;
            weight_ += weight;
        }
    }
    const uint32_t slot = ((value & 0x7fffffff) * 0x9e3779b1u) >> 24;
    if (minimum > 2 && predictions[static_cast<size_t>(Prediction::OtherWord)] != value) {
        const uint32_t back = recentEnd_ - positions_[slot], there = recent_[positions_[slot] % kRecent];
        if (back - 1 < kRecent - 1 && ((there ^ value) & 0x7fffffff) == 0) {
            word.other = static_cast<uint8_t>(back);
            word.negated = there != value;
        }
    }
    positions_[slot] = recentEnd_;
    recent_[recentEnd_++ % kRecent] = value;
}

template uint32_t WordPredictor::code(RangeWriter&, uint32_t, uint32_t, uint32_t);
template uint32_t WordPredictor::code(RangeReader&, uint32_t, uint32_t, uint32_t);

} // namespace mural::delta
