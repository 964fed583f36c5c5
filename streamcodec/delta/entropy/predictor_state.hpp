// Predictor state of changing entries: earlier values of their words. An entry holds the number of its state and passes
// it to its successor. The oldest state is overwritten.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "streamcodec/delta/dictionary/dictionary_entry.hpp"

namespace mural::delta {

// Prediction methods of a changed word. Each has a moving cost of its recent errors.
enum class Prediction : uint8_t { Same, IntegerLine, FloatLine, FloatCurve, OtherWord };
constexpr size_t kPredictions = 5;

struct WordState {
    uint32_t before = 0, twoBefore = 0;       // previous values; the last one is in the entry
    std::array<uint8_t, kPredictions> cost{}; // in quarters of a bit
    uint8_t other =
        0; // distance in changed words to the word this one is predicted from (Prediction::OtherWord); 0: none
    bool negated = false; // predicted with the opposite sign, as a float
};

// State of one entry.
struct EntryModel {
    uint64_t begin = 0; // index of its first word, counted from the start
    uint32_t words = 0; // 0: none
    uint32_t round = 0; // round of its last change
    double speed = 1;   // last time step relative to the one before
};

class PredictorState {
public:
    explicit PredictorState(uint32_t words)
        : words_(words), items_(std::min<size_t>(words / kMinWords + 2, DictionaryEntry::kMaxModels)) {}

    // Returns the state of an entry, creating it if needed.
    EntryModel& open(DictionaryEntry& item, std::span<const std::byte> bytes) {
        const auto words = static_cast<uint32_t>(bytes.size() / 4);
        if (EntryModel& known = items_[item.model < items_.size() ? item.model : 0];
            known.words == words && end_ - known.begin <= words_.size())
            return known;
        if (const uint64_t at = end_ % words_.size(); at + words > words_.size()) end_ += words_.size() - at;
        next_ = next_ + 1 < items_.size() ? next_ + 1 : 1;
        item.model = next_;
        items_[next_] = {.begin = end_, .words = words};
        end_ += words;
        for (uint32_t i = 0; i < words; ++i) {
            uint32_t value = 0;
            std::memcpy(&value, bytes.data() + size_t{i} * 4, 4);
            word(items_[next_], i) = {.before = value, .twoBefore = value, .cost = {40, 44, 44, 44, 48}};
        }
        return items_[next_];
    }
    WordState& word(const EntryModel& item, uint32_t i) { return words_[item.begin % words_.size() + i]; }

private:
    static constexpr uint32_t kMinWords = 8; // average words per state

    std::vector<WordState> words_;  // a ring
    std::vector<EntryModel> items_; // index 0 is unused
    uint64_t end_ = 0;
    uint32_t next_ = 0;
};

} // namespace mural::delta
