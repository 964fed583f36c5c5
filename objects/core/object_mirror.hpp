// The reader's side of distributed objects: the versions that this process has received. A state machine without
// sockets, clocks and threads.
#pragma once

#include <map>
#include <set>
#include <string_view>

#include "objects/core/blob_intake.hpp"
#include "objects/core/version_history.hpp"

namespace mural::objects {

// Receives the messages of one writer, in the order of each lane: the lane to all readers, and the lane to this reader.
// The lanes may overtake each other. A commit whose base is missing is not applied; the mirror requests the object
// instead.
//
// Frames: frame() ends the frame in preparation. Versions that arrive on the lane to all before the call belong to that
// frame. A session calls it for each Frame record of the stream.
//
// Thread safety: none. Returned states are immutable and may be used by any thread.
class ObjectMirror {
public:
    // Messages to the writer go to peer kWriter of `sink`.
    ObjectMirror(MessageSink& sink, const BlobIntakeOptions& options = {}) : sender_(sink), blobs_(sink, options) {}

    // Applies a message. An error names the object and the problem; all snapshots stay as they are.
    Result<void> input(std::span<const std::byte> message, int64_t nowNs);
    Result<void> input(const Message& message, int64_t nowNs);
    // Repeats requests without a reply.
    void tick(int64_t nowNs);

    void frame(uint64_t number);
    // Drops versions that only frames up to `number` use.
    void frameDone(uint64_t number);

    enum class Presence : uint8_t {
        Here,
        Waiting, // may arrive: announced, requested, or not yet known
        Gone,    // older than the kept versions
        Refused, // the writer no longer has it
        Unknown, // no such object
    };
    struct Found {
        Presence presence = Presence::Unknown;
        StatePointer state;                  // of Here
        const ShareMessage* share = nullptr; // valid until the next call; null of Unknown
    };
    // Returns a version of an object; version 0: the newest.
    [[nodiscard]] Found find(const AnyRef& ref) const;
    // Returns the version that a frame uses.
    [[nodiscard]] Found findAtFrame(const Uuid& id, uint64_t frame) const;
    [[nodiscard]] Version versionAtFrame(const Uuid& id, uint64_t frame) const; // 0: none
    // Returns the object with this name and type that a frame sees, preferably one with this layout. Null: none.
    [[nodiscard]] const ShareMessage* shareOf(std::string_view name, const archive::TypeLayout& layout,
                                              uint64_t frame) const;
    // Returns the types of the objects with this name, separated by commas.
    [[nodiscard]] std::string typesNamed(std::string_view name) const;
    [[nodiscard]] bool isKnown(const Uuid& id) const { return numbers_.contains(id); }

    // Requests an object, or missing blobs of its state, unless that is under way.
    void want(const AnyRef& ref, int64_t nowNs);

    [[nodiscard]] size_t objectCount() const { return objects_.size(); }
    [[nodiscard]] bool hasCatalogue() const { return hasCatalogue_; }
    // Commits that did not fit the received versions.
    [[nodiscard]] uint64_t gaps() const { return gaps_; }
    [[nodiscard]] BlobIntake& blobs() { return blobs_; }

private:
    struct Object {
        ShareMessage share;
        VersionHistory history;
        Version wanted = 0;             // requested version; 0: none
        int64_t wantedNs = 0;           // time of the last request
        Version refused = 0;            // versions up to this one are refused
        uint64_t endFrame = UINT64_MAX; // first frame without the object
    };
    Result<void> apply(const ShareMessage& message);
    Result<void> apply(const CommitMessage& message, int64_t nowNs);
    void apply(const OfferMessage& message, int64_t nowNs);
    void apply(const UnshareMessage& message);
    Result<void> apply(const RefuseMessage& message, int64_t nowNs);

    [[nodiscard]] const Object* objectOf(const Uuid& id) const;
    [[nodiscard]] Found found(const Object& object, Version version) const;
    void store(Object& object, StatePointer state, int64_t nowNs);
    void noteEarly(ObjectNumber number, Version version);
    void endCatalogue(int64_t nowNs);
    void requestBlobs(const ObjectState& state, int64_t nowNs);
    void request(Object& object, Version version, int64_t nowNs);
    // Drops what no unfinished frame uses. Returns true if nothing is left to drop later.
    bool settle(ObjectNumber number);

    MessageSender sender_;
    BlobIntake blobs_;
    std::map<ObjectNumber, Object> objects_;
    std::map<Uuid, ObjectNumber> numbers_;
    std::multimap<std::string, ObjectNumber, std::less<>> names_;
    // Objects whose messages overtook the catalogue: their last version, 0 after their end.
    std::map<ObjectNumber, Version> early_;
    std::set<ObjectNumber> aged_; // objects with more than one version, or ended
    uint64_t currentFrame_ = 1;   // in preparation
    uint64_t finishedFrame_ = 0;
    uint64_t gaps_ = 0;
    bool hasCatalogue_ = false;
};

} // namespace mural::objects
