// Writes objects for a reader that has none of them: the catalogue.
#pragma once

#include <functional>
#include <set>

#include "objects/core/message_sink.hpp"
#include "objects/core/object_state.hpp"

namespace mural::objects {

// How the bytes of blobs travel.
enum class BlobTransfer : uint8_t {
    Bytes, // BlobBegin and BlobData
    Place, // BlobAt, for processes of the same machine; small blobs as bytes
};

using MessageFunction = std::function<void(std::span<const std::byte> message)>;

// Sends a blob to emit().
void sendBlob(const Blob& blob, BlobTransfer transfer, const MessageFunction& emit);
// Sends the part of a blob from `offset` on as BlobData, raw.
void sendBlobBytes(const Blob& blob, uint64_t offset, uint64_t count, const MessageFunction& emit);
// The same, coded where that saves time on a connection of this rate; 0: unknown.
void sendBlobBytes(const Blob& blob, uint64_t offset, uint64_t count, PieceCoder& coder, uint64_t bytesPerSecond,
                   const MessageFunction& emit);

// Returns the commit that turns version `base`, or nothing, into `state`. The message refers to the bytes of `state`.
CommitMessage commitOf(ObjectNumber number, const ObjectState& state, const ObjectState* base);

class CatalogueWriter {
public:
    CatalogueWriter(BlobTransfer transfer, MessageFunction emit) : transfer_(transfer), emit_(std::move(emit)) {}

    // Writes the Share of an object; for pushed objects also the blobs and the newest state, for others the offer. A
    // state may be null. A state with missing blobs is written without these.
    void add(const ShareMessage& share, const StatePointer& state, Version offered);
    void end();

private:
    BlobTransfer transfer_;
    MessageFunction emit_;
    archive::ByteBuffer buffer_;
    std::set<BlobName> sent_;
    uint32_t count_ = 0;

    void emit(const Message& message);
};

} // namespace mural::objects
