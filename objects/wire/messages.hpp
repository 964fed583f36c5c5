// The messages between the writer, the keeper and the readers of objects. docs/architecture/objects.md has a table.
//
// A message is a kind and its contents, without a length: the stream or connection delimits messages. Decoding never
// trusts the sender: each count and length is checked before its use, and a decoded message refers to the bytes of the
// input, which must stay valid.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <mural/archive.hpp>
#include <mural/ref.hpp>
#include <mural/sharing.hpp>

#include "objects/blob/blob_memory.hpp"
#include "objects/blob/piece_coding.hpp"

namespace mural::objects {

// Number of an object, assigned by its writer in ascending order and never reused.
using ObjectNumber = uint32_t;

constexpr uint32_t kMaxObjects = 1U << 20; // shared at one time
constexpr size_t kMaxNameBytes = 255;
constexpr size_t kMaxLayoutBytes = 4096; // longer layouts are cut; the hash is of the whole
constexpr size_t kBlobPieceBytes = size_t{256} << 10;

enum class MessageKind : uint8_t {
    // From the writer.
    Share = 1,
    Commit,
    Offer,
    Unshare,
    BlobBegin,
    BlobData,
    BlobAt,
    Refuse,
    CatalogueEnd,
    // From a reader.
    Want,
    WantBlob,
    Token,
    // Queues.
    Ask,
    Item,
    Done,
    Closed,
    // Barriers.
    Enter,
    Go,
    Late,
    // Lanes with a limit.
    Part,
};

// A blob that encoded bytes refer to.
struct BlobRef {
    BlobName name{};
    uint64_t sizeBytes = 0;

    friend bool operator==(const BlobRef&, const BlobRef&) = default;
};

// Introduces an object. The first message about it.
struct ShareMessage {
    ObjectNumber number = 0;
    Uuid id{};
    Sharing sharing = Sharing::Delta;
    Delivery delivery = Delivery::Push;
    uint32_t keptVersions = 0;
    uint32_t mostUnread = 0; // above 0: readers send a Token after each commit
    uint32_t slotCount = 1;  // 1 to 64
    uint64_t layoutHash = 0;
    std::string name;
    std::string typeName;
    std::string layout; // in words
};

// One encoded slot. Slots: archive.hpp.
struct SlotValue {
    std::span<const std::byte> bytes;
    std::vector<BlobRef> blobs;
};

// A new version. Readers apply the values to version `base`; base 0: the values are all slots.
struct CommitMessage {
    ObjectNumber number = 0;
    Version version = 0;
    Version base = 0;
    uint64_t slots = 0; // a bit for each of `values`, ascending
    std::vector<SlotValue> values;
};

// Announces a version of an object that is delivered on demand.
struct OfferMessage {
    ObjectNumber number = 0;
    Version version = 0;
};

// Ends an object. Its number is not used again.
struct UnshareMessage {
    ObjectNumber number = 0;
};

// Begins a blob that follows as BlobData.
struct BlobBeginMessage {
    BlobRef blob;
};

struct BlobDataMessage {
    BlobName name{};
    uint64_t offset = 0; // of the raw bytes
    PieceCoding coding = PieceCoding::Raw;
    // Of a coded piece: size of the raw bytes, at most kBlobPieceBytes, and the time that the coding took.
    uint32_t rawBytes = 0, codingMicroseconds = 0;
    std::span<const std::byte> bytes;
};

// Names the memory of a blob, for processes of the writer's machine.
struct BlobAtMessage {
    BlobPlace place;
};

enum class Refusal : uint8_t {
    UnknownObject, // never shared, or no longer shared
    GoneVersion,   // no longer kept
    UnknownBlob,   // no object refers to it
};

// Replies to a Want that the writer cannot satisfy.
struct RefuseMessage {
    Refusal reason = Refusal::UnknownObject;
    ObjectNumber number = 0; // of Want
    Version version = 0;
    BlobName name{}; // of WantBlob
};

// Ends the description of all objects for a newcomer.
struct CatalogueEndMessage {
    uint32_t objectCount = 0;
};

// Requests a version, or a later one. `have`: the reader's version, 0 for none, to which the reply may refer.
struct WantMessage {
    ObjectNumber number = 0;
    Version version = 0; // 0: the newest
    Version have = 0;
};

struct WantBlobMessage {
    BlobName name{};
    uint64_t offset = 0;
    uint32_t count = 0;          // bytes
    bool takesPlace = false;     // the reader maps the whole blob if the reply is a BlobAt
    uint64_t bytesPerSecond = 0; // measured rate of the connection to the reader; 0: unknown
};

// Acknowledges that a reader has applied a version.
struct TokenMessage {
    ObjectNumber number = 0;
    Version version = 0;
};

// Requests items of a queue.
struct AskMessage {
    uint32_t queue = 0;
    uint32_t count = 0;
};

struct ItemMessage {
    uint32_t queue = 0;
    uint64_t item = 0;
    uint64_t frame = 0; // 0: belongs to no frame
    std::span<const std::byte> bytes;
};

// Reports that a reader has finished an item.
struct DoneMessage {
    uint32_t queue = 0;
    uint64_t item = 0;
};

// Reports that a queue is closed and all of its items are finished.
struct ClosedMessage {
    uint32_t queue = 0;
};

struct EnterMessage {
    uint32_t barrier = 0;
    uint64_t round = 0;
    uint32_t patienceMs = 0; // time until the member gives up; 0: none
};

// Releases all members of a round.
struct GoMessage {
    uint32_t barrier = 0;
    uint64_t round = 0;
    uint32_t entered = 0; // number of members
};

// Names the missing members to one that gave up. The member has left the round.
struct LateMessage {
    uint32_t barrier = 0;
    uint64_t round = 0;
    std::string missing; // names, separated by commas
};

// A part of a message that exceeds the limit of its lane; message_parts.hpp.
struct PartMessage {
    bool isLast = false;
    std::span<const std::byte> bytes;
};

using Message = std::variant<ShareMessage, CommitMessage, OfferMessage, UnshareMessage, BlobBeginMessage,
                             BlobDataMessage, BlobAtMessage, RefuseMessage, CatalogueEndMessage, WantMessage,
                             WantBlobMessage, TokenMessage, AskMessage, ItemMessage, DoneMessage, ClosedMessage,
                             EnterMessage, GoMessage, LateMessage, PartMessage>;

// Returns the message as bytes. Names and texts beyond their limits are cut.
archive::ByteBuffer encode(const Message& message);
void encodeInto(archive::ByteBuffer& out, const Message& message);

// Returns nothing for bytes that are no message.
std::optional<Message> decode(std::span<const std::byte> bytes);

// Returns the kind of an encoded message; 0 if it has none.
MessageKind kindOf(std::span<const std::byte> bytes);

// Returns the name of a kind, for diagnostics; "unknown" for others.
const char* nameOf(MessageKind kind);

} // namespace mural::objects
