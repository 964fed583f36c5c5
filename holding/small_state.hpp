// Small state of a context: capabilities, functions, masks, rectangles, each set whole by one command. What a command has to do with it.
#pragma once

#include <cstdint>

#include "recording/record_walk.hpp"

namespace mural::holding {

enum class StateRole : uint8_t {
    None,   // neither needs small state nor changes it
    Set,    // sets one of its cells
    Use,    // needs it: draws, clears, what saves it
    Change, // may change any of it in ways that are not followed
};

StateRole stateRoleOf(uint16_t opcode); // for CommandKinds, which remembers it

constexpr uint32_t kNoCell = UINT32_MAX;
constexpr uint32_t kStateWords = 6; // of the longest record of class Set that is certain

struct StateSet {
    uint32_t cell = kNoCell; // kNoCell: none that is followed
    bool certain = false;    // all of the cell is as the record says; else it may be refused, or sets a part only
    bool atOnce = false;     // where it stands counts: it can be left out, but not wait
};

// Of a command of class Set. unit: the active one of textures; some capabilities are the unit's.
StateSet stateSetOf(const recording::RecordView& r, uint32_t unit);

} // namespace mural::holding
