#include "objects/wire/messages.hpp"

#include <bit>

#include "objects/wire/message_bytes.hpp"

namespace mural::objects {

namespace {

constexpr uint8_t kHasBlobs = 1;
constexpr uint32_t kMaxWantedBytes = 64U << 20;
constexpr size_t kMaxMissingBytes = 4096;

std::string_view cut(const std::string& text, size_t most) { return std::string_view(text).substr(0, most); }

// Each message has a pair of functions: write() after the kind, and read() of the same contents.

void write(MessageWriter& to, const ShareMessage& m) {
    to.number(m.number);
    to.fixed(m.id);
    to.byte(static_cast<uint8_t>(m.sharing));
    to.byte(static_cast<uint8_t>(m.delivery));
    to.number(m.keptVersions);
    to.number(m.mostUnread);
    to.byte(static_cast<uint8_t>(m.slotCount));
    to.fixed(m.layoutHash);
    to.text(cut(m.name, kMaxNameBytes));
    to.text(cut(m.typeName, kMaxNameBytes));
    to.text(cut(m.layout, kMaxLayoutBytes));
}

void read(MessageReader& from, ShareMessage& m) {
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.id = from.fixed<Uuid>();
    const uint8_t sharing = from.byte(), delivery = from.byte();
    if (sharing > static_cast<uint8_t>(Sharing::Unbuffered) || delivery > static_cast<uint8_t>(Delivery::OnDemand))
        return from.fail();
    m.sharing = static_cast<Sharing>(sharing);
    m.delivery = static_cast<Delivery>(delivery);
    m.keptVersions = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.mostUnread = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.slotCount = from.byte();
    if (m.slotCount == 0 || m.slotCount > archive::kMaxSlots) return from.fail();
    m.layoutHash = from.fixed<uint64_t>();
    m.name = from.text(kMaxNameBytes);
    m.typeName = from.text(kMaxNameBytes);
    m.layout = from.text(kMaxLayoutBytes);
}

void write(MessageWriter& to, const CommitMessage& m) {
    bool hasBlobs = false;
    for (const SlotValue& value : m.values) hasBlobs = hasBlobs || !value.blobs.empty();
    to.number(m.number);
    to.number(m.version);
    to.byte(hasBlobs ? kHasBlobs : 0);
    to.number(m.base == 0 ? 0 : m.version - m.base);
    to.number(m.slots);
    for (const SlotValue& value : m.values) {
        to.sized(value.bytes);
        if (!hasBlobs) continue;
        to.number(value.blobs.size());
        for (const BlobRef& blob : value.blobs) {
            to.fixed(blob.name);
            to.number(blob.sizeBytes);
        }
    }
}

void read(MessageReader& from, CommitMessage& m) {
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.version = from.number();
    const uint8_t flags = from.byte();
    if (flags > kHasBlobs || m.version == 0) return from.fail();
    const uint64_t distance = from.numberUpTo(m.version - 1);
    m.base = distance == 0 ? 0 : m.version - distance;
    m.slots = from.number();
    const auto count = static_cast<size_t>(std::popcount(m.slots));
    m.values.reserve(count);
    for (size_t i = 0; i < count && from.ok(); ++i) {
        SlotValue value;
        value.bytes = from.sized();
        const uint64_t blobs = flags == kHasBlobs ? from.numberUpTo(value.bytes.size()) : 0;
        for (uint64_t k = 0; k < blobs && from.ok(); ++k) {
            BlobRef blob;
            blob.name = from.fixed<BlobName>();
            blob.sizeBytes = from.number();
            value.blobs.push_back(blob);
        }
        m.values.push_back(std::move(value));
    }
}

void write(MessageWriter& to, const OfferMessage& m) {
    to.number(m.number);
    to.number(m.version);
}
void read(MessageReader& from, OfferMessage& m) {
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.version = from.number();
}

void write(MessageWriter& to, const UnshareMessage& m) { to.number(m.number); }
void read(MessageReader& from, UnshareMessage& m) { m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX)); }

void write(MessageWriter& to, const BlobBeginMessage& m) {
    to.fixed(m.blob.name);
    to.number(m.blob.sizeBytes);
}
void read(MessageReader& from, BlobBeginMessage& m) {
    m.blob.name = from.fixed<BlobName>();
    m.blob.sizeBytes = from.number();
}

void write(MessageWriter& to, const BlobDataMessage& m) {
    to.fixed(m.name);
    to.number(m.offset);
    to.byte(static_cast<uint8_t>(m.coding));
    if (m.coding != PieceCoding::Raw) {
        to.number(m.rawBytes);
        to.number(m.codingMicroseconds);
    }
    to.raw(m.bytes);
}
void read(MessageReader& from, BlobDataMessage& m) {
    m.name = from.fixed<BlobName>();
    m.offset = from.number();
    const uint8_t coding = from.byte();
    if (coding >= kPieceCodings) return from.fail();
    m.coding = static_cast<PieceCoding>(coding);
    if (m.coding != PieceCoding::Raw) {
        m.rawBytes = static_cast<uint32_t>(from.numberUpTo(kBlobPieceBytes));
        m.codingMicroseconds = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    }
    m.bytes = from.rest();
}

void write(MessageWriter& to, const BlobAtMessage& m) {
    to.fixed(m.place.name);
    to.number(m.place.sizeBytes);
    to.number(static_cast<uint32_t>(m.place.pid));
    to.number(static_cast<uint32_t>(m.place.fd));
    to.number(m.place.inode);
}
void read(MessageReader& from, BlobAtMessage& m) {
    m.place.name = from.fixed<BlobName>();
    m.place.sizeBytes = from.number();
    m.place.pid = static_cast<int32_t>(from.numberUpTo(INT32_MAX));
    m.place.fd = static_cast<int32_t>(from.numberUpTo(INT32_MAX));
    m.place.inode = from.number();
}

void write(MessageWriter& to, const RefuseMessage& m) {
    to.byte(static_cast<uint8_t>(m.reason));
    to.number(m.number);
    to.number(m.version);
    to.fixed(m.name);
}
void read(MessageReader& from, RefuseMessage& m) {
    const uint8_t reason = from.byte();
    if (reason > static_cast<uint8_t>(Refusal::UnknownBlob)) return from.fail();
    m.reason = static_cast<Refusal>(reason);
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.version = from.number();
    m.name = from.fixed<BlobName>();
}

void write(MessageWriter& to, const CatalogueEndMessage& m) { to.number(m.objectCount); }
void read(MessageReader& from, CatalogueEndMessage& m) {
    m.objectCount = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
}

void write(MessageWriter& to, const WantMessage& m) {
    to.number(m.number);
    to.number(m.version);
    to.number(m.have);
}
void read(MessageReader& from, WantMessage& m) {
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.version = from.number();
    m.have = from.number();
}

void write(MessageWriter& to, const WantBlobMessage& m) {
    to.fixed(m.name);
    to.number(m.offset);
    to.number(m.count);
    to.byte(m.takesPlace);
    to.number(m.bytesPerSecond);
}
void read(MessageReader& from, WantBlobMessage& m) {
    m.name = from.fixed<BlobName>();
    m.offset = from.number();
    m.count = static_cast<uint32_t>(from.numberUpTo(kMaxWantedBytes));
    const uint8_t takesPlace = from.byte();
    if (takesPlace > 1) return from.fail();
    m.takesPlace = takesPlace != 0;
    m.bytesPerSecond = from.number();
}

void write(MessageWriter& to, const TokenMessage& m) {
    to.number(m.number);
    to.number(m.version);
}
void read(MessageReader& from, TokenMessage& m) {
    m.number = static_cast<ObjectNumber>(from.numberUpTo(UINT32_MAX));
    m.version = from.number();
}

void write(MessageWriter& to, const AskMessage& m) {
    to.number(m.queue);
    to.number(m.count);
}
void read(MessageReader& from, AskMessage& m) {
    m.queue = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.count = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
}

void write(MessageWriter& to, const ItemMessage& m) {
    to.number(m.queue);
    to.number(m.item);
    to.number(m.frame);
    to.raw(m.bytes);
}
void read(MessageReader& from, ItemMessage& m) {
    m.queue = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.item = from.number();
    m.frame = from.number();
    m.bytes = from.rest();
}

void write(MessageWriter& to, const DoneMessage& m) {
    to.number(m.queue);
    to.number(m.item);
}
void read(MessageReader& from, DoneMessage& m) {
    m.queue = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.item = from.number();
}

void write(MessageWriter& to, const ClosedMessage& m) { to.number(m.queue); }
void read(MessageReader& from, ClosedMessage& m) { m.queue = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX)); }

void write(MessageWriter& to, const EnterMessage& m) {
    to.number(m.barrier);
    to.number(m.round);
    to.number(m.patienceMs);
}
void read(MessageReader& from, EnterMessage& m) {
    m.barrier = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.round = from.number();
    m.patienceMs = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
}

void write(MessageWriter& to, const GoMessage& m) {
    to.number(m.barrier);
    to.number(m.round);
    to.number(m.entered);
}
void read(MessageReader& from, GoMessage& m) {
    m.barrier = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.round = from.number();
    m.entered = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
}

void write(MessageWriter& to, const LateMessage& m) {
    to.number(m.barrier);
    to.number(m.round);
    to.text(cut(m.missing, kMaxMissingBytes));
}
void read(MessageReader& from, LateMessage& m) {
    m.barrier = static_cast<uint32_t>(from.numberUpTo(UINT32_MAX));
    m.round = from.number();
    m.missing = from.text(kMaxMissingBytes);
}

void write(MessageWriter& to, const PartMessage& m) {
    to.byte(m.isLast);
    to.raw(m.bytes);
}
void read(MessageReader& from, PartMessage& m) {
    const uint8_t isLast = from.byte();
    if (isLast > 1) return from.fail();
    m.isLast = isLast != 0;
    m.bytes = from.rest();
}

// Message kinds are the indices of the variant, from 1 on.
static_assert(static_cast<size_t>(MessageKind::Part) == std::variant_size_v<Message>);

template <size_t Index> std::optional<Message> decodeAs(size_t index, MessageReader& from) {
    if constexpr (Index < std::variant_size_v<Message>) {
        if (index != Index) return decodeAs<Index + 1>(index, from);
        std::variant_alternative_t<Index, Message> message;
        read(from, message);
        if (!from.atEnd()) return std::nullopt;
        return Message(std::in_place_index<Index>, std::move(message));
    } else {
        return std::nullopt;
    }
}

} // namespace

void encodeInto(archive::ByteBuffer& out, const Message& message) {
    MessageWriter to(out);
    to.byte(static_cast<uint8_t>(message.index() + 1));
    std::visit([&to](const auto& contents) { write(to, contents); }, message);
}

archive::ByteBuffer encode(const Message& message) {
    archive::ByteBuffer out;
    encodeInto(out, message);
    return out;
}

std::optional<Message> decode(std::span<const std::byte> bytes) {
    MessageReader from(bytes);
    const uint8_t kind = from.byte();
    if (kind == 0) return std::nullopt;
    return decodeAs<0>(kind - 1U, from);
}

MessageKind kindOf(std::span<const std::byte> bytes) {
    return bytes.empty() ? MessageKind{} : static_cast<MessageKind>(bytes.front());
}

const char* nameOf(MessageKind kind) {
    constexpr const char* kNames[] = {"unknown", "Share",  "Commit",       "Offer", "Unshare",  "BlobBegin", "BlobData",
                                      "BlobAt",  "Refuse", "CatalogueEnd", "Want",  "WantBlob", "Token",     "Ask",
                                      "Item",    "Done",   "Closed",       "Enter", "Go",       "Late",      "Part"};
    const auto index = static_cast<size_t>(kind);
    return index < std::size(kNames) ? kNames[index] : kNames[0];
}

} // namespace mural::objects
