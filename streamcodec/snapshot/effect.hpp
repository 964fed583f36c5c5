// Effect of a command on the nodes' state, as accesses to keys.
#pragma once

#include <vector>

#include "streamcodec/snapshot/key_tree.hpp"

namespace mural::snapshot {

enum class Mode : uint8_t {
    Write,   // changes a part; the previous value still counts
    Kill,    // replaces everything; the previous value is dead
    Read,    // the command depends on it
    Forget,  // as Kill, without a new value: the object is deleted
    Close,   // ends an earlier command's effect: needed if any of it is kept
    Open,    // glPushAttrib: values that Restores of its glPopAttrib bring back
    Restore, // glPopAttrib: restores the value that the key had at the Open of the same level
};

struct EffectEntry {
    Key key;
    Mode mode;
    bool operator==(const EffectEntry&) const = default;
};

struct Effect {
    std::vector<EffectEntry> entries;
    bool always = false; // effects are not fully known: never removed

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

} // namespace mural::snapshot
