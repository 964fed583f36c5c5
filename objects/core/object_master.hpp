// The writer's side of distributed objects: all objects of a process. A state machine without sockets, clocks and
// threads.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "objects/core/catalogue_writer.hpp"
#include "objects/core/message_sink.hpp"
#include "objects/core/version_history.hpp"

namespace mural::objects {

struct MasterOptions {
    // How pushed blobs travel to all readers.
    BlobTransfer blobs = BlobTransfer::Bytes;
    // False if an ObjectKeeper serves newcomers: pushed states are then not kept, and join() sends nothing.
    bool keepsPushed = true;
    // Requests of several readers within this time are answered by one message to all. 0: each at once, to one.
    int64_t gatherNs = 2'000'000;
    // frame() is called for every frame: replaced blobs stay until the frame in preparation is drawn, also the first.
    bool hasFrames = false;
    // Largest sum of the values of a commit, as the lane to all readers permits.
    uint64_t mostCommitBytes = UINT64_MAX;
};

struct ObjectDescription {
    Uuid id{};
    ShareOptions options;
    archive::TypeLayout layout;
};

// The values of a commit, in ascending order of their slots. Not copied unless kept.
struct ObjectChange {
    struct Value {
        std::span<const std::byte> bytes;
        std::span<const Blob> blobs;
    };
    uint64_t slots = 0;
    std::vector<Value> values;
};

// Pushed objects need only the lane to all readers. Requests, tokens and their replies use the lanes to single peers.
//
// Thread safety: none.
class ObjectMaster {
public:
    ObjectMaster(MessageSink& sink, const MasterOptions& options = {})
        : sink_(sink), sender_(sink), options_(options) {}

    // Introduces an object. Errors: the name is too long, too many objects.
    Result<ObjectNumber> share(const ObjectDescription& description);
    // Commits the next version. The first commit has all slots, and with another sharing than Delta every commit.
    // Requires a shared object. Errors: a static object has a version, slots are missing, a value has 4 GiB or more.
    Result<Version> commit(ObjectNumber number, const ObjectChange& change);
    void unshare(ObjectNumber number);

    // Returns the name of a reader that is mostUnread commits behind; empty: commit() may be called.
    [[nodiscard]] std::optional<std::string> readerBehind(ObjectNumber number) const;
    [[nodiscard]] Version versionOf(ObjectNumber number) const;

    // A reader joins: it receives the catalogue, if pushed states are kept. Messages to all must reach it from then on.
    void join(PeerId reader, const std::string& name);
    // A reader is lost or leaves. Its tokens and requests no longer count.
    void leave(PeerId reader);

    // Applies a message of a reader. An error names the problem and the reader.
    Result<void> input(PeerId reader, std::span<const std::byte> message, int64_t nowNs);
    // Answers gathered requests.
    void tick(int64_t nowNs);

    // frame() ends the frame in preparation. Versions stay available until frameDone() of the last frame that uses
    // them.
    void frame(uint64_t number) { currentFrame_ = number + 1; }
    void frameDone(uint64_t number);

    [[nodiscard]] size_t objectCount() const { return objects_.size(); }
    // Returns the size of the kept states without blobs.
    [[nodiscard]] uint64_t keptBytes() const;

private:
    struct Object {
        ShareMessage share;
        VersionHistory history;
        Version version = 0;
        std::set<PeerId> holders; // of an object on demand; they receive its commits
        std::map<PeerId, Version> tokens;
    };
    // A request that waits for others of the same kind.
    struct Gathered {
        int64_t dueNs = 0;
        std::map<PeerId, Version> askers; // their versions, for objects
        uint64_t bytesPerSecond = 0;      // of the slowest reader, for blobs
    };
    using BlobRange = std::pair<BlobName, std::pair<uint64_t, uint32_t>>;

    [[nodiscard]] Result<void> verify(const Object& object, const ObjectChange& change) const;
    [[nodiscard]] StatePointer makeState(const Object& object, const ObjectChange& change, const ObjectState* before);
    std::shared_ptr<BlobEntry> entryFor(const Blob& blob);
    void pushBlobs(const Slot& slot);
    void releasePushes(const Slot& slot);
    void deliver(const Object& object, const ObjectChange& change, Version base);
    Result<void> want(PeerId reader, const WantMessage& message, int64_t nowNs);
    Result<void> wantBlob(PeerId reader, const WantBlobMessage& message, int64_t nowNs);
    void answerObject(ObjectNumber number, Version wanted, const std::map<PeerId, Version>& askers);
    void answerBlob(const BlobRange& range, const Gathered& gathered);
    [[nodiscard]] bool keeps(const Object& object) const;
    void emitTo(const std::map<PeerId, Version>& askers, std::span<const std::byte> message);
    void retire(std::shared_ptr<const Slot> slot);

    MessageSink& sink_;
    MessageSender sender_;
    const MasterOptions options_;
    std::map<ObjectNumber, Object> objects_;
    std::map<PeerId, std::string> readers_;
    std::map<BlobName, std::weak_ptr<BlobEntry>> blobs_; // of kept states
    size_t sweepAt_ = 64;                                // number of blobs at which expired ones are removed
    std::map<BlobName, uint32_t> pushes_;                // uses by the newest pushed states
    PieceCoder coder_;
    std::map<std::pair<ObjectNumber, Version>, Gathered> wantedObjects_;
    std::map<BlobRange, Gathered> wantedBlobs_;
    std::set<ObjectNumber> aged_; // objects with more than one version
    // Replaced slots with blobs, by the frame in preparation at that time: readers may not have received them yet.
    std::deque<std::pair<uint64_t, std::shared_ptr<const Slot>>> retired_;
    ObjectNumber next_ = 1;
    uint64_t currentFrame_ = 1;
    uint64_t finishedFrame_ = 0;
};

} // namespace mural::objects
