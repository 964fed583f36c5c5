// Dead-store elimination: goes over a log from its end to its beginning, and says of each command whether the state at the end,
// or a command behind it that stays, needs it.
//
// Each key has the time (counted in steps of the sweep) at which it was last said to be needed or not; what was said last of it or of
// any key above it holds.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "recording/kept/effect.hpp"

namespace mural::recording {

class Sweep {
public:
    static constexpr uint32_t kNobody = 0xffffffff;

    explicit Sweep(const KeyTree& keys) : keys_(keys), marks_(keys.size()) {}

    // The commands from the last to the first, by numbers of the caller's. True: it stays. A command that was not needed may turn
    // out to be later on, by `keepsAfterAll`.
    bool command(uint32_t number, std::span<const EffectEntry> effect, bool always);
    std::function<void(uint32_t number)> keepsAfterAll;

private:
    struct Mark {
        uint64_t said = 0;      // step << 1 | not needed
        uint64_t readBelow = 0; // the same, of the last that was needed below
        uint32_t closer = kNobody;
    };
    struct Restored { // by an attribute stack's level
        std::vector<std::pair<Key, bool>> keys; // needed behind it
        bool all = false;
    };

    [[nodiscard]] bool needed(Key key) const;
    [[nodiscard]] bool anyNeeded(Key key) const;
    void need(Key key);
    void mention(Key key);
    void open(Key key);

    const KeyTree& keys_;
    std::vector<Mark> marks_;
    std::unordered_map<Key, Restored> restored_;
    uint64_t step_ = 1;
};

} // namespace mural::recording
