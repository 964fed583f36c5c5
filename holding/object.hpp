// A texture, a buffer or the uniforms of a program, with what of it nobody has needed yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "holding/cells.hpp"
#include "holding/upload.hpp"

namespace mural::holding {

enum class Kind : uint8_t { Texture, Buffer, Program };

constexpr size_t kUniformWords = 22; // of the longest record that sets one: glProgramUniformMatrix4fv

// A record that is held, with the pieces of its value before it.
struct Item {
    std::vector<std::byte> bytes;
    uint32_t recordAt = 0; // where the record begins, behind pieces
    uint32_t records = 0;
    uint32_t target = 0;   // at which the object has to be bound; 0: the record names it
    bool isUpload = false, barrier = false; // barrier: reads what was uploaded before it
    UploadKind kind = UploadKind::Part;
    Place place;
    Shape shape;
};

// What is worth its time with this object: where twice nothing was won, the next ones are not tried.
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

// Whether objects that have just begun to be are worth to be held: where many in a row were drawn at once, most are not tried.
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
    uint32_t target = 0;   // of a texture: what it was bound to first
    bool open = false;     // others than draws with it bound may use or change it: nothing of it is held
    std::vector<Item> queue; // held, in their order
    Cells<kUniformWords> uniforms; // of a program, by location, those that are no array; what waits is behind the queue
    size_t heldBytes = 0;
    uint64_t heldSince = 0; // frame in which the first of the queue came
    bool filled = false;    // something was uploaded
    bool gained = false;    // something of the queue was replaced
    Worth holding, comparing;
    struct Known {
        Place place;
        Shape shape;
        std::optional<Sum> sum; // none of what came first: most never comes again
    };
    std::vector<Known> known; // what is in it, when the queue has been sent

    [[nodiscard]] bool waits() const { return !queue.empty() || uniforms.waiting(); }
    void forget() { // what is in it; nothing may wait
        known.clear();
        uniforms.forgetAll();
    }
    enum class News : uint8_t { Same, Changed, First }; // First: there was none like it
    // Whether the upload changes anything of what is there. Remembers it.
    // first: of all of the object's.
    News compare(const Upload& u, bool first, const std::function<Sum()>& sum);
    // It comes, whatever it has.
    void forgets(const Upload& u);
    // Takes out of the queue what the upload replaces before anything has read it; how much that was.
    struct Replaced {
        uint32_t records = 0;
        size_t sizeBytes = 0;
    };
    Replaced replaces(const Upload& u);
};

} // namespace mural::holding
