// GL state tracker: determines the reads and writes of each record, by tracking the state that decides them. A record
// with unknown effects reads everything and is never removed: a gap costs bytes, not pixels.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "streamcodec/snapshot/effect.hpp"
#include "streamcodec/snapshot/tracked_state.hpp"
#include "streamcodec/wire/record_walk.hpp"

namespace mural::snapshot {

using wire::argumentWord;
using wire::RecordView;
using wire::RecordWalk;

class GlStateTracker {
public:
    explicit GlStateTracker(KeyTree& keys) : keys_(keys) {}

    // Adds the record's effects to `effect`. Returns false if it forms one command with the following records of the
    // stream.
    bool record(uint32_t stream, const RecordView& r, Effect& effect);
    // Returns the side effects of the last command on context state, other than its drawing, as records that set that
    // state. If they are replayed, the command itself matters only for its pixels.
    std::vector<std::byte> takeSideEffects(uint32_t stream) { return std::exchange(streams_[stream].sideEffects, {}); }
    void clientGone(uint32_t client);
    // Visits all tracked keys.
    void forEachKey(const std::function<void(Key)>& take) const;

private:
    struct At; // context of one record

    void own(At& at, const RecordView& r);
    void createContext(At& at, const RecordView& r);
    void destroyContext(At& at, const RecordView& r);
    void makeCurrent(At& at, const RecordView& r);
    void window(At& at, const RecordView& r);
    void bufferBytes(At& at, const RecordView& r);

    void gl(At& at, const RecordView& r);
    void execute(At& at, const RecordView& r);
    void unknown(At& at, bool names);
    void compiled(At& at, const RecordView& r);
    void callList(At& at, uint32_t name);
    void callLists(At& at, const RecordView& r);
    void lists(At& at, const EffectRule& rule, const RecordView& r);
    bool hasSideEffects(At& at, const EffectRule& rule, const RecordView& r);
    void readState(At& at);
    void readAll(At& at);
    void readPicture(At& at);
    void readTextures(At& at);

    // State.
    Key cell(const At& at, Key above, uint32_t kind, const EffectRule& rule, const RecordView& r);
    void set(At& at, Key key, uint32_t attribBits);
    void setClient(At& at, Key key);
    void state(At& at, const EffectRule& rule, const RecordView& r);
    void cap(At& at, const EffectRule& rule, const RecordView& r);
    void colorMaterial(At& at);
    void limit(At& at, const RecordView& r);
    void matrix(At& at, const EffectRule& rule, const RecordView& r);
    void pushAttribs(At& at, std::vector<SavedAttribs>& stack, Part part, uint32_t mask);
    void popAttribs(At& at, std::vector<SavedAttribs>& stack, Part part);

    // Objects.
    Object* find(At& at, ObjectType type, uint32_t name);
    Object* make(At& at, ObjectType type, uint32_t name);
    Object* findOrMake(At& at, ObjectType type, uint32_t name);
    Objects& tableOf(At& at, ObjectType type);
    void retain(At& at, Object*& slot, Object* next);
    void release(At& at, Object* object);
    void erase(At& at, Object* object);
    void objects(At& at, const EffectRule& rule, const RecordView& r);
    void deleteNames(At& at, ObjectType type, const RecordView& r);
    void deleteOne(At& at, ObjectType type, uint32_t name);
    void use(At& at, Object* object);
    Object* bound(At& at, uint64_t binding) const;
    void bind(At& at, const EffectRule& rule, const RecordView& r);
    void bindPlain(At& at, const EffectRule& rule, uint64_t slot, uint32_t name);
    void bindTexture(At& at, const EffectRule& rule, uint32_t place, uint32_t name);
    void bindBuffer(At& at, const EffectRule& rule, uint32_t target, uint32_t name);
    void bindVertexArray(At& at, const EffectRule& rule, uint32_t name);
    void bindSlot(At& at, uint64_t slot, Key key, uint32_t attribBits, Object* object);
    void arrays(At& at, const EffectRule& rule, const RecordView& r);
    void useUntracked(At& at, const EffectRule& rule, const RecordView& r, bool makes);
    void shaders(At& at, const EffectRule& rule, const RecordView& r);
    void buffers(At& at, const EffectRule& rule, const RecordView& r);
    void writeBuffer(At& at, Object* buffer, uint64_t offset, uint64_t sizeBytes);
    void queries(At& at, const EffectRule& rule, const RecordView& r);
    void textures(At& at, const EffectRule& rule, const RecordView& r);
    Object* texture(At& at, uint32_t target, bool readsBinding);
    void framebuffers(At& at, const EffectRule& rule, const RecordView& r);
    Object* framebuffer(At& at, uint32_t target);
    void handles(At& at, const EffectRule& rule, const RecordView& r);
    Object* textureOf(At& at, const HandleId& handle);
    void pages(At& at, const EffectRule& rule, const RecordView& r);

    // Pictures.
    void draw(At& at);
    void drawBitmap(At& at);
    void drawGathered(At& at);
    void planes(At& at, uint32_t mask, bool covers);
    void windowPlanes(At& at, uint32_t mask, bool covers);
    void framebufferPlanes(At& at, Object& target, uint32_t mask, bool covers);
    void writeMemory(At& at);
    void clear(At& at, const EffectRule& rule, const RecordView& r);

    [[nodiscard]] Key part(Key above, Part kind, uint64_t a = 0, uint64_t b = 0) {
        return keys_.child(above, static_cast<uint32_t>(kind), a, b);
    }

    KeyTree& keys_;
    std::map<uint32_t, ClientNames> clients_;
    std::unordered_map<uint32_t, StreamNames> streams_;
};

// Reads names from a value in the arguments, from that word on. Returns false if they travel as a blob, or are missing.
bool namesAt(const RecordView& r, size_t word, std::vector<uint32_t>& names);
inline uint64_t argumentWide(const RecordView& r, size_t word) {
    return argumentWord(r, word) | uint64_t{argumentWord(r, word + 1)} << 32;
}

struct GlStateTracker::At {
    uint32_t stream;
    ClientNames& client;
    StreamNames& thread;
    ContextNames* context; // null: no current context
    Effect& effect;
    uint64_t blobBytes = 0; // size of the first pending blob
};

} // namespace mural::snapshot
