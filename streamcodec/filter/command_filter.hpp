// Command filter: defers texture, buffer and uniform uploads until the first command that may read them. Drops uploads
// that a later upload overwrites before that, and uploads that do not change the contents.
//
// Each object has a queue. The queue holds the deferred uploads of the object, and later commands on the same object.
// The filter flushes it before the first command that may read the object:
// - a draw while the object is bound,
// - a command with unknown reads,
// - any command of another context of the share group.
// A flush binds the object, sends the queue, and restores the previous binding. The filter therefore tracks bindings,
// but no other state. A command without an effect rule (streamcodec/snapshot) disables deferral for its share group.
//
// setDropsRedundant() adds the setters of small state (state_setters.hpp). Each cell of state then holds its latest
// setter until a command reads the state.
//
// Assumption: calls that bind something are valid. GL rejects an invalid upload at any position.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <unordered_map>

#include "streamcodec/filter/command_class.hpp"
#include "streamcodec/filter/filter_contexts.hpp"
#include "streamcodec/filter/output.hpp"
#include "streamcodec/filter/state_setters.hpp"

namespace mural::filter {

struct CommandFilterCounts {
    uint64_t inBytes = 0, outBytes = 0;
    uint64_t deferredRecords = 0; // total deferred
    uint64_t droppedRecords = 0;  // dropped: overwritten, redundant, or deleted with their object
    uint64_t droppedBytes = 0;
    uint64_t deferredBytes = 0; // currently deferred
    uint64_t alikeRecords = 0;  // equal to the previous frame, and therefore not tracked
};

// Not thread-safe.
class CommandFilter {
public:
    // maxBytes: limit of deferred data; above it the oldest is flushed.
    CommandFilter(uint64_t maxBytes, Take take);
    CommandFilter(const CommandFilter&) = delete;
    CommandFilter& operator=(const CommandFilter&) = delete;

    void add(uint32_t stream, std::span<const std::byte> payload);
    void releaseAll();                // flushes everything
    void clientGone(uint32_t client); // drops everything of the program
    // Sets whether redundant state setters, bindings and uniforms are dropped. Initially off. Call between packets.
    void setDropsRedundant(bool dropsRedundant);
    void losesDeferredUploads() { loses_ = true; } // fault injection
    [[nodiscard]] const CommandFilterCounts& counts() const { return counts_; }

private:
    using RecordView = wire::RecordView;
    // passed by reference: copying the span would stall on store forwarding per record
    using Packet = std::span<const std::byte>;
    struct At { // context of one record
        Stream& stream;
        Context& context;
        Group& group;
        Output& output;
        const RecordView& r;
        const CommandKind& kind;
        size_t from; // position in the packet of the record, or of the first piece of its blob
        const Packet& packet;
    };

    void record(Stream& stream, Output& output, const RecordView& r, const CommandKind& kind, size_t from,
                const Packet& packet);
    void passOthers(Stream& stream, Output& output, wire::RecordWalk& walk, const Packet& packet, bool tracksState);
    void keepPending(Stream& stream, Output& output, size_t from, const Packet& packet);
    void sendPending(Stream& stream, Output& output, size_t from);
    static bool bindsHere(const Stream& stream) {
        return stream.context != nullptr && !stream.context->group->untracked && !stream.inPrimitive;
    }
    static bool compilesList(const Stream& stream) {
        return stream.list != 0 && stream.context != nullptr && !stream.context->group->untracked &&
               stream.same.now != FrameMatcher::Now::Matching;
    }
    void gl(At& at);
    void arrays(At& at);

    // Frames that repeat the previous one.
    [[nodiscard]] bool mayRepeat(const Stream& stream) const;
    [[nodiscard]] bool repeats(const Stream& stream) const;
    void passSame(Stream& stream, wire::RecordWalk& walk, const Packet& packet);
    void seeSame(Stream& stream, const RecordView& r, const CommandKind& kind);
    void trackSame(Stream& stream);
    void trackSameTo(Stream& stream, size_t to);
    void leaveSame(Stream& stream);
    void leaveSameOf(const Group& group);
    void keepSame(Stream& stream, const RecordView& r, const Packet& packet);
    void keepRecords(Stream& stream, const Packet& packet);
    void endSame(Stream& stream, const Packet& packet);

    // Redundant state.
    bool smallState(Stream& stream, Output& output, const RecordView& r, StateRole role, size_t from,
                    const Packet& packet);
    void countFate(const SetResult& outcome, size_t sizeBytes);
    [[nodiscard]] bool setsNothing(const Group& group, uint32_t list) const;
    void sendState(Stream& stream, Output& output, size_t from);
    void sendStateOf(Stream& stream);
    void sendUniformsOf(Group& group);
    template <size_t Words> void dropWaiting(const StateCache<Words>& cells) {
        counts_.deferredBytes -= cells.waitingBytes();
        countLeftOut(cells.waitingRecords(), cells.waitingBytes());
    }

    // Control records.
    void own(Stream& stream, Output& output, const RecordView& r, size_t from);
    void createContext(Stream& stream, const RecordView& r);
    void makeCurrent(Stream& stream, Output& output, const RecordView& r, size_t from);
    void destroyContext(Stream& stream, Output& output, const RecordView& r, size_t from);
    void dropDestroyed(uint32_t client, Context* context);

    // Bindings.
    void bind(At& at);
    void isRedundantBind(At& at); // drops the record if it changes nothing
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

    // Objects.
    Object* find(Group& group, Kind kind, uint32_t name) const;
    Object* make(Group& group, Kind kind, uint32_t name);
    // null for name 0, and for an unknown name, which disables deferral
    Object* named(At& at, Kind kind, uint32_t name);
    Object* textureAt(At& at, uint32_t target);
    Object* bufferAt(const Context& c, uint32_t target) const;
    void generate(At& at);
    static VertexArray* makeArray(Context& c, uint32_t name);
    void deleteNames(At& at);
    void deleteObject(At& at, Object* object);
    void openUp(At& at, Object* object); // excludes the object from deferral
    void openNamed(At& at, Kind kind, size_t word);

    // Uploads.
    void upload(At& at);
    Object* objectOf(At& at);
    void deferUpload(At& at, Object& object, const Upload* upload, bool barrier);
    void waitsFor(At& at, Object& object);
    void oneUniform(At& at, Object& program, size_t locationWord);
    void countLeftOut(size_t records, size_t sizeBytes);
    void objectCommand(At& at);
    Sum sumOfValue(At& at, const Upload& upload);

    void list(At& at);
    void compiled(At& at);

    // Flushing: inserts records before byte `from` of the output's packet.
    void use(At& at);
    enum class Because : uint8_t { Needed, NoRoom };
    void release(Stream& stream, Output& output, size_t from, std::span<Object* const> objects,
                 Because because = Because::Needed);
    void releaseOne(At& at, Object& object);
    static bool deferrable(Group& group, Object& object);
    bool makeRoom(Stream& stream, Output& output, size_t from, uint64_t sizeBytes);
    void releaseGroup(Stream& stream, Output& output, size_t from);
    void releaseOf(Group& group, Stream& stream, Output& output, size_t from);
    void releaseElsewhere(Stream& stream);
    void emptyQueue(Group& group, Object& object);
    void dropQueue(Group& group, Object& object);
    void sendQueue(Context& c, Output& output, size_t from, Object& object);
    void untrack(At& at);

    const CommandKinds& kinds_ = CommandKinds::all();
    const uint64_t maxBytes_;
    const Take take_; // also counts the sent records
    std::unordered_map<uint32_t, Stream> streams_;
    std::map<uint32_t, std::map<uint32_t, std::unique_ptr<Context>>> clients_;
    std::vector<std::byte> scratch_, otherScratch_;
    std::vector<Object*> used_;   // objects that the draw uses
    std::vector<uint32_t> names_; // names in the current record
    uint64_t pendingBytes_ = 0;
    bool dropsRedundant_ = false;
    bool loses_ = false;
    CommandFilterCounts counts_;
};

// Reads names from the record's arguments at that word. Returns false if they travel as a blob.
bool namesAt(const wire::RecordView& r, size_t word, std::vector<uint32_t>& names);
// Index into TextureUnit; kTextureTargets: unknown. Faces of a cube map to the cube.
size_t targetIndex(uint32_t target);
// Returns true for capabilities that enable driver messages per command.
bool isDebugOutput(uint32_t cap);

} // namespace mural::filter
