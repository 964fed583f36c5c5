// The commands of all programs, in their order, but for those that nothing needs any more: what is kept, given to a fresh node, makes
// it as the others are now. Appending costs a look at each record; every time the log has doubled, one pass over it finds what can
// go, so that it stays in proportion to what is alive.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "recording/kept/effect.hpp"
#include "recording/kept/follower.hpp"

namespace mural::recording {

class KeptLog {
public:
    KeptLog() : follower_(keys_) {}

    // pinned: what the records need is kept, but they themselves are the caller's.
    void append(uint32_t stream, std::span<const std::byte> payload, bool pinned = false);
    void record(uint32_t stream, const RecordView& r, std::span<const std::byte> bytes, bool pinned);
    void clientGone(uint32_t client); // nothing of it is needed any more
    // Leaves out what is not needed. `append` does that by itself, from time to time.
    void compact();
    bool compactIfGrown();
    void settlePending(); // what streams have begun is as it is: the rest of it comes pinned

    // What is kept, in its order: a command at a time, some of them several records; then what streams have begun.
    void forEach(const std::function<void(uint32_t stream, std::span<const std::byte> records)>& take) const;
    [[nodiscard]] size_t sizeBytes() const; // of memory
    [[nodiscard]] size_t records() const { return items_.size(); }
    void clear();

private:
    struct Item {
        std::unique_ptr<std::byte[]> large; // null: in bytes_
        size_t at = 0;                      // there
        uint32_t sizeBytes = 0;
        uint32_t stream = 0;
        uint32_t effectAt = 0, effects = 0;
        bool always = false, pinned = false;
    };
    struct Pending { // records that belong together, of which more come
        std::vector<std::byte> bytes;
        Effect effect;
    };
    void put(uint32_t stream, std::span<const std::byte> bytes, const Effect& effect, bool pinned);
    void forgetKeys();

    KeyTree keys_;
    Follower follower_;
    std::vector<Item> items_;
    std::vector<EffectEntry> effects_;
    std::vector<std::byte> bytes_; // of small items
    size_t largeBytes_ = 0;
    std::unordered_map<uint32_t, Pending> pending_;
    size_t grownItems_ = 0, grownBytes_ = 0, grownKeys_ = 0; // when these are reached, a pass is due
};

} // namespace mural::recording
