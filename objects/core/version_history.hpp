// The versions of one object that are still in use.
#pragma once

#include <deque>

#include "objects/core/object_state.hpp"

namespace mural::objects {

// A version belongs to the frame that was in preparation when it was committed, and to later frames until the next
// version. Versions that only finished frames use are dropped, except `kept` older ones.
class VersionHistory {
public:
    struct Entry {
        Version version = 0;
        uint64_t frame = 0; // first frame that uses it
        StatePointer state; // null: announced, not received
    };

    // The frame of versions that arrived before their announcement.
    static constexpr uint64_t kNotAnnounced = UINT64_MAX;

    // Adds a version, or completes the entry of a known one. Returns false if nothing is new.
    bool add(Version version, uint64_t frame, StatePointer state);
    // Makes all versions up to this one usable from a frame on, and adds it without a state if it is unknown.
    void announce(Version version, uint64_t frame);

    // Drops versions that no frame after `finishedFrame` uses, except `kept` of them. The newest always stays, and so
    // does the newest with a state.
    void trim(uint64_t finishedFrame, uint32_t kept);
    // Keeps the newest version with a state, and announced later ones.
    void keepNewest();

    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] size_t size() const { return entries_.size(); }
    [[nodiscard]] Version newest() const { return entries_.empty() ? 0 : entries_.back().version; }
    [[nodiscard]] Version oldest() const { return entries_.empty() ? 0 : entries_.front().version; }
    // Returns the newest version with a state, or null.
    [[nodiscard]] StatePointer newestState() const;
    // Returns the state of a version, or null.
    [[nodiscard]] StatePointer at(Version version) const;
    // Returns the version that a frame uses, 0 if the frame precedes all known versions.
    [[nodiscard]] Version versionAtFrame(uint64_t frame) const;
    [[nodiscard]] const std::deque<Entry>& entries() const { return entries_; }

private:
    std::deque<Entry> entries_; // versions ascend, frames do not descend
};

} // namespace mural::objects
