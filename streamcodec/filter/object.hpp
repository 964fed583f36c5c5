// A texture, a buffer, or the uniforms of a program, with its deferred commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "streamcodec/filter/state_cache.hpp"
#include "streamcodec/filter/upload.hpp"

namespace mural::filter {

enum class Kind : uint8_t { Texture, Buffer, Program };

constexpr size_t kUniformWords = 22; // longest record that sets a uniform: glProgramUniformMatrix4fv

// A deferred record with the pieces of its blob.
struct Item {
    std::vector<std::byte> bytes;
    uint32_t recordAt = 0; // start of the record, after the pieces
    uint32_t records = 0;
    uint32_t target = 0;                    // target at which the object must be bound; 0: the record contains the name
    bool isUpload = false, barrier = false; // barrier: reads earlier uploads
    UploadKind kind = UploadKind::Part;
    Place place;
    Shape shape;
};

// Success counter of an optimization for one object: after two failures it is tried less often.
class Worth {
public:
    [[nodiscard]] bool tries() {
        if (vain_ < kPatience) return true;
        if (++skipped_ < kSkips) return false;
        skipped_ = 0;
        vain_ = kPatience - 1;
        return true;
    }
    [[nodiscard]] bool vain() const { return vain_ >= kPatience; }
    void won() { vain_ = 0; }
    void lost() { vain_ = vain_ < kPatience ? vain_ + 1 : kPatience; }

private:
    static constexpr uint8_t kPatience = 2;
    static constexpr uint32_t kSkips = 64;
    uint8_t vain_ = 0;
    uint32_t skipped_ = 0;
};

// Tracks whether deferring uploads of new objects pays off: if many in a row were drawn immediately, most are not
// deferred.
class SoonUsed {
public:
    [[nodiscard]] bool tries() { return inARow_ < kPatience || ++skipped_ % kSkips == 0; }
    [[nodiscard]] bool vain() const { return inARow_ >= kPatience; }
    void was(bool soon) { inARow_ = soon ? inARow_ + 1 : 0; }

private:
    static constexpr uint32_t kPatience = 16, kSkips = 8;
    uint32_t inARow_ = 0, skipped_ = 0;
};

struct Object {
    Kind kind = Kind::Texture;
    uint32_t name = 0;
    uint32_t target = 0;     // texture: target of its first binding
    bool open = false;       // other commands than draws may read or change it: never deferred
    std::vector<Item> queue; // deferred commands in order
    StateCache<kUniformWords>
        uniforms; // program: uniforms that are not arrays, by location; a flush sends them after the queue
    size_t deferredBytes = 0;
    uint64_t deferredSince = 0; // frame of the first deferred command
    bool filled = false;        // has been uploaded to
    bool gained = false;        // a deferred upload was overwritten
    Worth deferral, comparing;
    struct Known {
        Place place;
        Shape shape;
        std::optional<Sum> sum; // empty for first uploads: most never recur
    };
    std::vector<Known> known; // contents after the queue is flushed

    [[nodiscard]] bool waits() const { return !queue.empty() || uniforms.waiting(); }
    void forget() { // marks the contents as unknown; requires an empty queue
        known.clear();
        uniforms.forgetAll();
    }
    enum class Comparison : uint8_t { Same, Changed, First }; // First: no comparable upload
    // Compares an upload with the known contents, and records it. first: first upload of the object.
    Comparison compare(const Upload& u, bool first, const std::function<Sum()>& sum);
    // Records an upload without comparison.
    void forgets(const Upload& u);
    // Removes deferred uploads that this upload overwrites before any read; returns their number and size.
    struct Replaced {
        uint32_t records = 0;
        size_t sizeBytes = 0;
    };
    Replaced replaces(const Upload& u);
};

} // namespace mural::filter
