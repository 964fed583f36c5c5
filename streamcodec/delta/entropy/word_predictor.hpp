// Codes changed words relative to a prediction. Animated floats follow a line or a curve through their last values. The
// first word that does reveals the time step of this frame, which the following words use. Both sides use identical
// arithmetic: IEEE doubles without fused operations (CMakeLists.txt), only finite and normal values.
#pragma once

#include <array>
#include <cstdint>

#include "streamcodec/delta/entropy/range_coder.hpp"
#include "streamcodec/delta/entropy/predictor_state.hpp"

namespace mural::delta {

class WordPredictor {
public:
    explicit WordPredictor(uint32_t modelWords) : models_(modelWords) {}

    // Begins an entry with its old bytes. Creates its predictor state if needed.
    void begin(DictionaryEntry& item, std::span<const std::byte> bytes);
    // Codes word `i`, which changes from `old` to `now`. Returns the new value.
    template <class Coder> uint32_t code(Coder& coder, uint32_t i, uint32_t old, uint32_t now);
    void end();

private:
    using Guesses = std::array<uint32_t, kPredictions>;

    // Parts of a float's extrapolation that are needed after its value is known.
    struct Curve {
        bool known = false;
        double value = 0, slope = 0; // predicted value; derivative by the speed
    };
    [[nodiscard]] Curve prediction(const WordState& word, uint32_t old, Guesses& predictions) const;
    template <class Coder> uint32_t codeDistance(Coder& coder, uint32_t context, uint32_t distance);
    void update(WordState& word, uint32_t value, const Guesses& predictions, const Curve& curve);

    PredictorState models_;
    EntryModel* item_ = nullptr;
    WordState* word_ = nullptr; // state of the entry's first word
    double bendShare_ = 0;      // fraction of the change of steps per time step

    // A round: every changing entry changes once.
    uint32_t round_ = 1;
    double speed_ = 1, weight_ = 0;

    static constexpr uint32_t kRecent = 256;
    std::array<uint32_t, kRecent> recent_{};    // recent values of changed words, a ring
    std::array<uint32_t, kRecent> positions_{}; // position in recent_ by hash
    uint32_t recentEnd_ = 0;

    static constexpr uint32_t kContexts = 18;
    std::array<SymbolModel, kContexts> widths_{};
};

} // namespace mural::delta
