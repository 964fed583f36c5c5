// Small state of a context: capabilities, functions, masks and rectangles, each set completely by one command.
// Determines the role of each command for this state, so that the command filter can drop redundant setters.
#pragma once

#include <cstdint>

#include "streamcodec/wire/record_walk.hpp"

namespace mural::filter {

enum class StateRole : uint8_t {
    None,   // neither reads nor changes small state
    Set,    // sets one cell
    Use,    // reads it: draws, clears, commands that save state
    Change, // may change any cell in ways that are not tracked
};

StateRole stateRoleOf(uint16_t opcode); // slow; CommandKinds caches the result

constexpr uint32_t kNoCell = UINT32_MAX;
constexpr uint32_t kStateWords = 6; // words of the longest record of role Set with a certain result

struct StateSet {
    uint32_t cell = kNoCell; // kNoCell: not tracked
    bool certain = false;    // the record sets the whole cell; otherwise GL may refuse it, or it sets only a part
    bool atOnce = false;     // position matters: the record can be dropped, but not deferred
};

// Returns the cell that a command of role Set sets. unit: the active texture unit, to which some capabilities belong.
StateSet stateSetOf(const wire::RecordView& r, uint32_t unit);

} // namespace mural::filter
