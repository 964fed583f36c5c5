// What is known of the words of items that change: their values before the last. An item has the number of its model, which goes on
// to what takes its place; the oldest model gives its room up.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "economy/item.hpp"

namespace mural::economy {

// How a changed word may be expected, and at what cost each has been wrong of late.
enum class Guess : uint8_t { Same, IntegerLine, FloatLine, FloatCurve, Other };
constexpr size_t kGuesses = 5;

struct WordModel {
    uint32_t before = 0, twoBefore = 0;      // the last value is in the item
    std::array<uint8_t, kGuesses> cost{};    // quarters of a bit
    uint8_t other = 0;                       // so many changed words before this one was one like it: Guess::Other; 0: none
    bool negated = false;                    // as a float
};

// Of an item.
struct ItemModel {
    uint64_t begin = 0;    // of its words, counted from the first of all
    uint32_t words = 0;    // 0: there is none
    uint32_t round = 0;    // in which it has changed last
    double speed = 1;      // its last step in time by the one before
};

class WordModels {
public:
    explicit WordModels(uint32_t words) : words_(words), items_(std::min<size_t>(words / kLeastWords + 2, Item::kMostModels)) {}

    // The model of an item of these bytes; the item gets its number.
    ItemModel& open(Item& item, std::span<const std::byte> bytes) {
        const auto words = static_cast<uint32_t>(bytes.size() / 4);
        if (ItemModel& known = items_[item.model < items_.size() ? item.model : 0]; known.words == words && end_ - known.begin <= words_.size()) return known;
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
    WordModel& word(const ItemModel& item, uint32_t i) { return words_[item.begin % words_.size() + i]; }

private:
    static constexpr uint32_t kLeastWords = 8; // of a model, on average

    std::vector<WordModel> words_; // a ring
    std::vector<ItemModel> items_; // the first is none
    uint64_t end_ = 0;
    uint32_t next_ = 0;
};

} // namespace mural::economy
