#include "objects/core/object_keeper.hpp"

#include <algorithm>

#include "objects/core/commit_application.hpp"
#include "objects/core/object_names.hpp"

namespace mural::objects {

BlobIntakeOptions ObjectKeeper::defaultOptions() {
    BlobIntakeOptions options;
    options.storeBytes = 0;
    options.open.keepDescriptor = true;
    return options;
}

Result<void> ObjectKeeper::input(std::span<const std::byte> bytes, int64_t nowNs) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    if (const auto* share = std::get_if<ShareMessage>(&*message)) return apply(*share);
    if (const auto* commit = std::get_if<CommitMessage>(&*message)) return apply(*commit, nowNs);
    if (const auto* begin = std::get_if<BlobBeginMessage>(&*message)) return blobs_.input(*begin);
    if (const auto* data = std::get_if<BlobDataMessage>(&*message)) return blobs_.input(*data, nowNs);
    if (const auto* at = std::get_if<BlobAtMessage>(&*message)) return blobs_.input(*at, nowNs), Result<void>();
    if (const auto* refuse = std::get_if<RefuseMessage>(&*message)) return blobs_.input(*refuse, nowNs);
    if (const auto* offer = std::get_if<OfferMessage>(&*message)) {
        const auto found = objects_.find(offer->number);
        if (found != objects_.end()) found->second.offered = std::max(found->second.offered, offer->version);
    } else if (const auto* unshare = std::get_if<UnshareMessage>(&*message)) {
        remove(unshare->number);
    } else if (!std::holds_alternative<CatalogueEndMessage>(*message)) {
        return unexpectedMessage(*message, "the keeper of objects");
    }
    return {};
}

Result<void> ObjectKeeper::apply(const ShareMessage& message) {
    if (const auto known = objects_.find(message.number); known != objects_.end()) {
        if (known->second.share.id == message.id) return {};
        return Error{describe(message) + " has the number of " + describe(known->second.share) + "; it is refused"};
    }
    if (objects_.size() >= kMaxObjects)
        return Error{describe(message) + " is refused: " + std::to_string(kMaxObjects) + " objects are shared already"};
    objects_[message.number].share = message;
    return {};
}

Result<void> ObjectKeeper::apply(const CommitMessage& message, int64_t nowNs) {
    const auto found = objects_.find(message.number);
    if (found == objects_.end())
        return Error{"a commit of object number " + std::to_string(message.number) +
                     " precedes its Share; it is ignored"};
    Object& object = found->second;
    if (object.share.delivery == Delivery::OnDemand) return {}; // a reply to several readers
    if (object.state && message.version <= object.state->version) return {};
    const bool fits = message.base == 0 || (object.state && object.state->version == message.base);
    StatePointer state;
    if (fits)
        state = stateAfter(message, message.base == 0 ? nullptr : object.state.get(), object.share.slotCount,
                           [this](const BlobRef& ref) { return blobs_.entryFor(ref); });
    blobs_.releasePushed();
    if (!state)
        return Error{describe(object.share) + ": version " + std::to_string(message.version) +
                     " does not follow version " + std::to_string(object.state ? object.state->version : 0) +
                     "; newcomers receive the older one"};
    for (const auto& slot : state->slots)
        for (const auto& entry : slot->blobs)
            if (!entry->isHere) blobs_.request(entry, nowNs);
    sizeBytes_ += state->sizeBytes();
    if (object.state) sizeBytes_ -= object.state->sizeBytes();
    object.state = std::move(state);
    return {};
}

void ObjectKeeper::remove(ObjectNumber number) {
    const auto found = objects_.find(number);
    if (found == objects_.end()) return;
    if (found->second.state) sizeBytes_ -= found->second.state->sizeBytes();
    objects_.erase(found);
}

void ObjectKeeper::writeCatalogue(BlobTransfer transfer, const MessageFunction& emit) const {
    CatalogueWriter writer(transfer, emit);
    for (const auto& [number, object] : objects_) writer.add(object.share, object.state, object.offered);
    blobs_.writePushed(transfer, emit); // the keeper may stand between a blob and its commit
    writer.end();
}

StatePointer ObjectKeeper::newest(const Uuid& id) const {
    for (const auto& [number, object] : objects_)
        if (object.share.id == id) return object.state;
    return nullptr;
}

} // namespace mural::objects
