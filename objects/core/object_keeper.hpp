// The party between the writer and its readers: keeps the newest state of all objects, without knowledge of their
// types, for readers that join later. A state machine without sockets, clocks and threads.
#pragma once

#include <map>

#include "objects/core/blob_intake.hpp"
#include "objects/core/catalogue_writer.hpp"
#include "objects/core/message_sink.hpp"

namespace mural::objects {

// Receives the messages to all readers, in their order. Memory: the newest states and their blobs; blobs of the same
// machine are mapped.
class ObjectKeeper {
public:
    // Requests for blobs that could not be mapped go to peer kWriter of `sink`.
    explicit ObjectKeeper(MessageSink& sink, const BlobIntakeOptions& options = defaultOptions())
        : blobs_(sink, options) {}
    // Blobs stay shareable with other processes, and those without a use are dropped.
    static BlobIntakeOptions defaultOptions();

    // Merges a message. An error means a damaged or unexpected message; the states stay as they are.
    Result<void> input(std::span<const std::byte> message, int64_t nowNs);
    void tick(int64_t nowNs) { blobs_.tick(nowNs); }

    // Writes everything that a reader needs to continue with the next message.
    void writeCatalogue(BlobTransfer transfer, const MessageFunction& emit) const;

    // Returns a blob that the newest states refer to or that has just been announced; empty if it is unknown. A session
    // uses it to replace BlobAt for readers of other machines.
    [[nodiscard]] Blob blob(const BlobName& name) { return blobs_.store().find(name); }

    // Returns the newest state of an object; null: none.
    [[nodiscard]] StatePointer newest(const Uuid& id) const;
    [[nodiscard]] size_t objectCount() const { return objects_.size(); }
    // Returns the size of the states without blobs.
    [[nodiscard]] uint64_t sizeBytes() const { return sizeBytes_; }
    // Returns the size of the blobs.
    [[nodiscard]] uint64_t blobBytes() { return blobs_.store().sizeBytes(); }

private:
    struct Object {
        ShareMessage share;
        StatePointer state;
        Version offered = 0;
    };
    Result<void> apply(const ShareMessage& message);
    Result<void> apply(const CommitMessage& message, int64_t nowNs);
    void remove(ObjectNumber number);

    BlobIntake blobs_;
    std::map<ObjectNumber, Object> objects_;
    uint64_t sizeBytes_ = 0;
};

} // namespace mural::objects
