// Changed words, by what they are expected to be: floats that programs move come nearly as a line or a curve through the last values
// goes on, and what one word tells of how long this frame's step in time is, is used for those behind it. Both sides do the same
// arithmetic: IEEE doubles, no operations joined (CMakeLists.txt), nothing that is not finite, nothing that is denormal.
#pragma once

#include <array>
#include <cstdint>

#include "economy/range_coder.hpp"
#include "economy/word_models.hpp"

namespace mural::economy {

class WordCoder {
public:
    explicit WordCoder(uint32_t modelWords) : models_(modelWords) {}

    // The words that follow are of this item, as it was; it gets a model if it has none.
    void begin(Item& item, std::span<const std::byte> bytes);
    // Word `i`, which was `old`, is `now`. Returns it.
    template <class Coder> uint32_t code(Coder& coder, uint32_t i, uint32_t old, uint32_t now);
    void end();

private:
    using Guesses = std::array<uint32_t, kGuesses>;

    // What of the float's curve is needed again once its value is known.
    struct Curve {
        bool known = false;
        double value = 0, slope = 0; // expected, and by the speed
    };
    [[nodiscard]] Curve guess(const WordModel& word, uint32_t old, Guesses& guesses) const;
    template <class Coder> uint32_t codeDistance(Coder& coder, uint32_t context, uint32_t distance);
    void learn(WordModel& word, uint32_t value, const Guesses& guesses, const Curve& curve);

    WordModels models_;
    ItemModel* item_ = nullptr;
    WordModel* word_ = nullptr; // its first
    double bendShare_ = 0;      // how much of a change of its steps one more step in time bends

    // Of this round: all items that change once.
    uint32_t round_ = 1;
    double speed_ = 1, weight_ = 0;

    static constexpr uint32_t kRecent = 256;
    std::array<uint32_t, kRecent> recent_{}; // values of changed words: a ring
    std::array<uint32_t, kRecent> places_{}; // where in it a value may be, by its hash
    uint32_t recentEnd_ = 0;

    static constexpr uint32_t kContexts = 18;
    std::array<SymbolModel, kContexts> widths_{};
};

} // namespace mural::economy
