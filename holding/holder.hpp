// Holds back what nobody needs yet: uploads of textures, of buffers and to uniforms, until a record comes that may use them. What a
// later one replaces before that is not sent, nor what changes nothing.
//
// An upload waits in the queue of its object, with all that is done to the object behind it; small state, where that is wanted, by what it
// sets; nothing else is put off. An upload goes out
// before the first record that may use the object: a draw with it bound, a command of which that is not known, any record of
// another context that shares it. There it is bound for it, and what was bound is bound again. What the program does is followed as far
// as bindings go; a command that recording/kept has no rule for ends holding in its share group.
//
// Calls are taken to be valid where they bind something; an upload that is refused is refused wherever it stands.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <unordered_map>

#include "holding/command_class.hpp"
#include "holding/names.hpp"
#include "holding/output.hpp"
#include "holding/small_state.hpp"

namespace mural::holding {

struct HolderCounts {
    uint64_t inBytes = 0, outBytes = 0;
    uint64_t heldRecords = 0;    // that ever were
    uint64_t leftOutRecords = 0; // those that were replaced, changed nothing, or went with their object
    uint64_t leftOutBytes = 0;
    uint64_t heldBytes = 0;      // now
    uint64_t alikeRecords = 0;   // that were as in the frame before, and not followed
};

// One thread at a time.
class Holder {
public:
    // mostBytes: of what is held; beyond that it is sent.
    Holder(uint64_t mostBytes, Take take);
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

    void add(uint32_t stream, std::span<const std::byte> payload);
    void releaseAll();               // all that is held is sent now
    void clientGone(uint32_t client); // nobody needs it any more
    // Whether small state, bindings and uniforms go only where they change something; between two packets. At first all of it goes.
    void leaveOutSmall(bool leavesOut);
    void losesWhatItHolds() { loses_ = true; } // a fault on purpose, for tests of the tests
    [[nodiscard]] const HolderCounts& counts() const { return counts_; }

private:
    using RecordView = recording::RecordView;
    using Packet = std::span<const std::byte>; // by reference: one on the stack that is read whole waits for its halves, for each record
    struct At { // a record
        Stream& stream;
        Context& context;
        Group& group;
        Output& output;
        const RecordView& r;
        const CommandKind& kind;
        size_t from; // in the packet: of the first piece of its value, or of the record
        const Packet& packet;
    };

    void record(Stream& stream, Output& output, const RecordView& r, const CommandKind& kind, size_t from, const Packet& packet);
    void passOthers(Stream& stream, Output& output, recording::RecordWalk& walk, const Packet& packet, bool looksAtState);
    void keepPending(Stream& stream, Output& output, size_t from, const Packet& packet);
    void sendPending(Stream& stream, Output& output, size_t from);
    static bool bindsHere(const Stream& stream) { return stream.context != nullptr && !stream.context->group->untracked && !stream.inPrimitive; }
    static bool compilesList(const Stream& stream) { return stream.list != 0 && stream.context != nullptr && !stream.context->group->untracked && stream.same.now != SameFrames::Now::Following; }
    void gl(At& at);
    void arrays(At& at);

    // Frames like the one before
    [[nodiscard]] bool mayRepeat(const Stream& stream) const;
    [[nodiscard]] bool repeats(const Stream& stream) const;
    void passSame(Stream& stream, recording::RecordWalk& walk, const Packet& packet);
    void seeSame(Stream& stream, const RecordView& r, const CommandKind& kind);
    void followSame(Stream& stream);
    void followSameTo(Stream& stream, size_t to);
    void leaveSame(Stream& stream);
    void leaveSameOf(const Group& group);
    void keepSame(Stream& stream, const RecordView& r, const Packet& packet);
    void keepRecords(Stream& stream, const Packet& packet);
    void endSame(Stream& stream, const Packet& packet);

    // Small state
    bool smallState(Stream& stream, Output& output, const RecordView& r, StateRole role, size_t from, const Packet& packet);
    void countFate(const Outcome& outcome, size_t sizeBytes);
    [[nodiscard]] bool setsNothing(const Group& group, uint32_t list) const;
    void sendState(Stream& stream, Output& output, size_t from);
    void sendStateOf(Stream& stream);
    void sendUniformsOf(Group& group);
    template <size_t Words>
    void dropWaiting(const Cells<Words>& cells) {
        counts_.heldBytes -= cells.waitingBytes();
        countLeftOut(cells.waitingRecords(), cells.waitingBytes());
    }

    // Mural's records
    void own(Stream& stream, Output& output, const RecordView& r, size_t from);
    void createContext(Stream& stream, const RecordView& r);
    void makeCurrent(Stream& stream, Output& output, const RecordView& r, size_t from);
    void destroyContext(Stream& stream, Output& output, const RecordView& r, size_t from);
    void dropDestroyed(uint32_t client, Context* context);

    // What is bound
    void bind(At& at);
    void boundAlready(At& at); // the record changes nothing
    void bindTexture(At& at, uint32_t target, uint32_t unit, Object* object);
    void bindBuffer(At& at, uint32_t target, uint32_t name);
    void bindIndexed(At& at);
    void bindVertexArray(At& at, uint32_t name);
    void arrayBuffers(At& at);
    void bindFramebuffer(At& at);
    void useProgram(At& at, uint32_t name);
    void arrayPointer(At& at);
    void pushAttribs(At& at);
    void popAttribs(At& at);
    void pushClientAttribs(At& at);
    void popClientAttribs(At& at);

    // Objects
    Object* find(Group& group, Kind kind, uint32_t name) const;
    Object* make(Group& group, Kind kind, uint32_t name);
    Object* named(At& at, Kind kind, uint32_t name); // null: 0, or an unknown one, which ends holding
    Object* textureAt(At& at, uint32_t target);
    Object* bufferAt(const Context& c, uint32_t target) const;
    void generate(At& at);
    static VertexArray* makeArray(Context& c, uint32_t name);
    void deleteNames(At& at);
    void deleteObject(At& at, Object* object);
    void openUp(At& at, Object* object); // nothing of it is held from now on
    void openNamed(At& at, Kind kind, size_t word);

    // Uploads
    void upload(At& at);
    Object* objectOf(At& at);
    void hold(At& at, Object& object, const Upload* upload, bool barrier);
    void waitsFor(At& at, Object& object);
    void oneUniform(At& at, Object& program, size_t locationWord);
    void countLeftOut(size_t records, size_t sizeBytes);
    void objectCommand(At& at);
    Sum sumOfValue(At& at, const Upload& upload);

    void list(At& at);
    void compiled(At& at);

    // Releasing: before the byte `from` of the output's packet
    void use(At& at);
    enum class Because : uint8_t { Needed, NoRoom };
    void release(Stream& stream, Output& output, size_t from, std::span<Object* const> objects, Because because = Because::Needed);
    void releaseOne(At& at, Object& object);
    static bool mayWait(Group& group, Object& object);
    bool makeRoom(Stream& stream, Output& output, size_t from, uint64_t sizeBytes);
    void releaseGroup(Stream& stream, Output& output, size_t from);
    void releaseOf(Group& group, Stream& stream, Output& output, size_t from);
    void releaseElsewhere(Stream& stream);
    void emptyQueue(Group& group, Object& object);
    void dropQueue(Group& group, Object& object);
    void sendQueue(Context& c, Output& output, size_t from, Object& object);
    void untrack(At& at);

    const CommandKinds& kinds_ = CommandKinds::all();
    const uint64_t mostBytes_;
    const Take take_; // counts what goes
    std::unordered_map<uint32_t, Stream> streams_;
    std::map<uint32_t, std::map<uint32_t, std::unique_ptr<Context>>> clients_;
    std::vector<std::byte> scratch_, otherScratch_;
    std::vector<Object*> used_; // by the draw
    std::vector<uint32_t> names_; // of the record in hand
    uint64_t pendingBytes_ = 0;
    bool leavesOutSmall_ = false;
    bool loses_ = false;
    HolderCounts counts_;
};

// Of a record's arguments, at that word: names that lie in the record; false: they travel ahead of it.
bool namesAt(const recording::RecordView& r, size_t word, std::vector<uint32_t>& names);
// By which TextureUnit is counted; kTextureTargets: unknown. Faces of a cube are the cube.
size_t targetIndex(uint32_t target);
// While it is enabled the program hears of each command when its driver speaks.
bool hearsDriver(uint32_t cap);

} // namespace mural::holding
