// Dead-store elimination: a backward pass over a log that decides, for each command, whether the final state or a later
// live command needs it.
//
// Each key has the time (in steps of the sweep) of its last mark, live or dead. The latest mark of a key or any
// ancestor counts.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "streamcodec/snapshot/effect.hpp"

namespace mural::snapshot {

class LivenessSweep {
public:
    static constexpr uint32_t kNobody = 0xffffffff;

    explicit LivenessSweep(const KeyTree& keys) : keys_(keys), marks_(keys.size()) {}

    // Visits commands from last to first, with numbers chosen by the caller. Returns true if the command is live. A
    // dead command may become live later, by `keepsAfterAll`.
    bool command(uint32_t number, std::span<const EffectEntry> effect, bool always);
    std::function<void(uint32_t number)> keepsAfterAll;

private:
    struct Mark {
        uint64_t marked = 0;    // step << 1 | dead
        uint64_t readBelow = 0; // the same, of the last live mark in the subtree
        uint32_t closer = kNobody;
    };
    struct Restored {                           // by attribute stack level
        std::vector<std::pair<Key, bool>> keys; // live after it
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

} // namespace mural::snapshot
