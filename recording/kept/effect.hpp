// What a command does to the state of the nodes, as keys.
#pragma once

#include <vector>

#include "recording/kept/key_tree.hpp"

namespace mural::recording {

enum class Mode : uint8_t {
    Write,   // a part of it changes: what it was before still counts
    Kill,    // all of it is new: what it was before counts no more
    Read,    // what the command does depends on it
    Forget,  // as Kill, but nothing that would be missed: it is gone
    Close,   // ends what an earlier command has begun or made: needed where anything of that is kept
    Open,    // glPushAttrib: what the Restores of its glPopAttrib bring back is as here
    Restore, // glPopAttrib: it is as it was at the Open of the key that this command closes
};

struct EffectEntry {
    Key key;
    Mode mode;
    bool operator==(const EffectEntry&) const = default;
};

struct Effect {
    std::vector<EffectEntry> entries;
    bool always = false; // nobody knows all that it does: never left out

    void add(Key key, Mode mode) {
        if (entries.empty() || entries.back() != EffectEntry{key, mode}) entries.push_back({key, mode});
    }
    void write(Key key) { add(key, Mode::Write); }
    void kill(Key key) { add(key, Mode::Kill); }
    void read(Key key) { add(key, Mode::Read); }
    void clear() {
        entries.clear();
        always = false;
    }
};

} // namespace mural::recording
