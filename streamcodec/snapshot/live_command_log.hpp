// Log of the commands of all programs, without those that have no remaining effect. Replaying it brings a fresh node to
// the current state. Appending examines each record; whenever the log has doubled, a liveness sweep removes dead
// commands, so its size stays proportional to the live state.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "streamcodec/snapshot/effect.hpp"
#include "streamcodec/snapshot/gl_state_tracker.hpp"

namespace mural::snapshot {

class LiveCommandLog {
public:
    LiveCommandLog() : tracker_(keys_) {}

    // pinned: everything the records need is kept, but the caller stores the records themselves.
    void append(uint32_t stream, std::span<const std::byte> payload, bool pinned = false);
    void record(uint32_t stream, const wire::RecordView& r, std::span<const std::byte> bytes, bool pinned);
    void clientGone(uint32_t client); // removes everything of the program
    // Removes dead commands. append() calls it from time to time.
    void compact();
    bool compactIfGrown();
    void settlePending(); // freezes incomplete commands; their remainder arrives pinned

    // Visits the live commands in order, each possibly several records, then the incomplete commands of streams.
    void forEach(const std::function<void(uint32_t stream, std::span<const std::byte> records)>& take) const;
    [[nodiscard]] size_t sizeBytes() const; // memory in use
    [[nodiscard]] size_t records() const { return items_.size(); }
    void clear();

private:
    struct Item {
        std::unique_ptr<std::byte[]> large; // null: stored in bytes_
        size_t at = 0;                      // offset there
        uint32_t sizeBytes = 0;
        uint32_t stream = 0;
        uint32_t effectAt = 0, effects = 0;
        bool always = false, pinned = false;
    };
    struct Pending { // an incomplete command
        std::vector<std::byte> bytes;
        Effect effect;
    };
    void put(uint32_t stream, std::span<const std::byte> bytes, const Effect& effect, bool pinned);
    void forgetKeys();

    KeyTree keys_;
    GlStateTracker tracker_;
    std::vector<Item> items_;
    std::vector<EffectEntry> effects_;
    std::vector<std::byte> bytes_; // small entries
    size_t largeBytes_ = 0;
    std::unordered_map<uint32_t, Pending> pending_;
    size_t grownItems_ = 0, grownBytes_ = 0, grownKeys_ = 0; // thresholds of the next sweep
};

} // namespace mural::snapshot
