#include "objects/core/catalogue_writer.hpp"

#include <algorithm>

namespace mural::objects {

namespace {

template <class MakePiece>
void sendPieces(const Blob& blob, uint64_t offset, uint64_t count, const MessageFunction& emit, MakePiece makePiece) {
    const auto bytes = blob.bytes();
    archive::ByteBuffer buffer;
    const uint64_t from = std::min<uint64_t>(offset, bytes.size());
    const uint64_t end = from + std::min<uint64_t>(count, bytes.size() - from);
    for (uint64_t at = from; at < end; at += kBlobPieceBytes) {
        buffer.clear();
        const uint64_t pieceBytes = std::min<uint64_t>(kBlobPieceBytes, end - at);
        const CodedPiece piece = makePiece(bytes.subspan(at, pieceBytes));
        encodeInto(buffer, BlobDataMessage{blob.name(), at, piece.coding, static_cast<uint32_t>(pieceBytes),
                                           piece.codingMicroseconds, piece.bytes});
        emit(buffer.bytes());
    }
}

} // namespace

void sendBlobBytes(const Blob& blob, uint64_t offset, uint64_t count, const MessageFunction& emit) {
    sendPieces(blob, offset, count, emit, [](std::span<const std::byte> raw) {
        return CodedPiece{PieceCoding::Raw, raw, 0};
    });
}

void sendBlobBytes(const Blob& blob, uint64_t offset, uint64_t count, PieceCoder& coder, uint64_t bytesPerSecond,
                   const MessageFunction& emit) {
    sendPieces(blob, offset, count, emit,
               [&](std::span<const std::byte> raw) { return coder.code(blob.name(), raw, bytesPerSecond); });
}

void sendBlob(const Blob& blob, BlobTransfer transfer, const MessageFunction& emit) {
    if (blob.empty()) return;
    if (transfer == BlobTransfer::Place) {
        if (const auto place = placeOf(blob)) return emit(encode(BlobAtMessage{*place}).bytes());
    }
    emit(encode(BlobBeginMessage{{blob.name(), blob.sizeBytes()}}).bytes());
    sendBlobBytes(blob, 0, blob.sizeBytes(), emit);
}

CommitMessage commitOf(ObjectNumber number, const ObjectState& state, const ObjectState* base) {
    CommitMessage message;
    message.number = number;
    message.version = state.version;
    message.base = base ? base->version : 0;
    for (size_t i = 0; i < state.slots.size(); ++i) {
        const auto& slot = state.slots[i];
        if (base && base->slots[i] == slot) continue;
        message.slots |= uint64_t{1} << i;
        SlotValue value;
        value.bytes = slot->bytes;
        for (const auto& entry : slot->blobs) value.blobs.push_back(entry->ref);
        message.values.push_back(std::move(value));
    }
    return message;
}

void CatalogueWriter::emit(const Message& message) {
    buffer_.clear();
    encodeInto(buffer_, message);
    emit_(buffer_.bytes());
}

void CatalogueWriter::add(const ShareMessage& share, const StatePointer& state, Version offered) {
    ++count_;
    emit(share);
    if (share.delivery == Delivery::OnDemand) {
        if (offered > 0) emit(OfferMessage{share.number, offered});
        return;
    }
    if (!state) return;
    for (const auto& slot : state->slots)
        for (const auto& entry : slot->blobs)
            if (entry->isHere && sent_.insert(entry->ref.name).second) sendBlob(entry->blob, transfer_, emit_);
    emit(commitOf(share.number, *state, nullptr));
}

void CatalogueWriter::end() { emit(CatalogueEndMessage{count_}); }

} // namespace mural::objects
