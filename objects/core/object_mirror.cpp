#include "objects/core/object_mirror.hpp"

#include <algorithm>

#include "objects/core/commit_application.hpp"
#include "objects/core/object_names.hpp"

namespace mural::objects {

Result<void> ObjectMirror::input(std::span<const std::byte> bytes, int64_t nowNs) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    return input(*message, nowNs);
}

Result<void> ObjectMirror::input(const Message& message, int64_t nowNs) {
    if (const auto* share = std::get_if<ShareMessage>(&message)) return apply(*share);
    if (const auto* commit = std::get_if<CommitMessage>(&message)) return apply(*commit, nowNs);
    if (const auto* begin = std::get_if<BlobBeginMessage>(&message)) return blobs_.input(*begin);
    if (const auto* data = std::get_if<BlobDataMessage>(&message)) return blobs_.input(*data, nowNs);
    if (const auto* at = std::get_if<BlobAtMessage>(&message)) return blobs_.input(*at, nowNs), Result<void>();
    if (const auto* refuse = std::get_if<RefuseMessage>(&message)) return apply(*refuse, nowNs);
    if (const auto* offer = std::get_if<OfferMessage>(&message)) {
        apply(*offer, nowNs);
    } else if (const auto* unshare = std::get_if<UnshareMessage>(&message)) {
        apply(*unshare);
    } else if (std::holds_alternative<CatalogueEndMessage>(message)) {
        endCatalogue(nowNs);
    } else {
        return unexpectedMessage(message, "a reader of objects");
    }
    return {};
}

Result<void> ObjectMirror::apply(const ShareMessage& message) {
    if (const auto known = objects_.find(message.number); known != objects_.end()) {
        if (known->second.share.id == message.id) return {}; // announced and in the catalogue
        return Error{describe(message) + " has the number of " + describe(known->second.share) +
                     "; both are refused until the writer is restarted"};
    }
    if (const auto early = early_.find(message.number); early != early_.end() && early->second == 0) return {};
    if (objects_.size() >= kMaxObjects)
        return Error{describe(message) + " is refused: " + std::to_string(kMaxObjects) + " objects are shared already"};
    if (const auto [at, isNew] = numbers_.try_emplace(message.id, message.number); !isNew) {
        const auto old = objects_.find(at->second);
        if (old != objects_.end() && old->second.endFrame == UINT64_MAX)
            return Error{describe(message) + " has the identifier of " + describe(old->second.share) +
                         "; share it with a new identifier"};
        at->second = message.number;
    }
    objects_[message.number].share = message;
    names_.emplace(message.name, message.number);
    return {};
}

Result<void> ObjectMirror::apply(const CommitMessage& message, int64_t nowNs) {
    const auto found = objects_.find(message.number);
    if (found == objects_.end()) {
        noteEarly(message.number, message.version);
        return {};
    }
    Object& object = found->second;
    const bool isOnDemand = object.share.delivery == Delivery::OnDemand;
    if (isOnDemand && object.wanted == 0 && !object.history.newestState()) return {}; // requested by others
    const uint64_t frame = isOnDemand ? VersionHistory::kNotAnnounced : currentFrame_;
    if (object.history.at(message.version)) return {}; // applied already
    const StatePointer base = message.base == 0 ? nullptr : object.history.at(message.base);
    if (message.base != 0 && !base) {
        if (object.history.newestState() && message.version < object.history.newestState()->version) return {};
        ++gaps_;
        object.history.add(message.version, frame, nullptr);
        request(object, message.version, nowNs);
        return {};
    }
    StatePointer state = stateAfter(message, base.get(), object.share.slotCount,
                                    [this](const BlobRef& ref) { return blobs_.entryFor(ref); });
    blobs_.releasePushed();
    if (!state)
        return Error{describe(object.share) + ": version " + std::to_string(message.version) +
                     " has other fields than announced; its last version stays in use"};
    store(object, std::move(state), nowNs);
    return {};
}

void ObjectMirror::store(Object& object, StatePointer state, int64_t nowNs) {
    const Version version = state->version;
    const bool isOnDemand = object.share.delivery == Delivery::OnDemand;
    requestBlobs(*state, nowNs);
    object.history.add(version, isOnDemand ? VersionHistory::kNotAnnounced : currentFrame_, std::move(state));
    if (object.wanted != 0 && version >= object.wanted) object.wanted = 0;
    if (object.share.mostUnread > 0) sender_.toOne(kWriter, TokenMessage{object.share.number, version});
    if (object.share.sharing == Sharing::Unbuffered) {
        object.history.keepNewest();
    } else if (object.history.size() > 1) {
        object.history.trim(finishedFrame_, object.share.keptVersions);
        aged_.insert(object.share.number);
    }
}

// Without the catalogue, an unknown object may be introduced later. With it, the object has ended.
void ObjectMirror::noteEarly(ObjectNumber number, Version version) {
    if (hasCatalogue_ || early_.size() >= kMaxObjects) return;
    const auto [at, isNew] = early_.try_emplace(number, version);
    if (isNew || at->second == 0) return;
    at->second = version == 0 ? 0 : std::max(at->second, version);
}

void ObjectMirror::endCatalogue(int64_t nowNs) {
    hasCatalogue_ = true;
    for (const auto& [number, version] : std::exchange(early_, {})) {
        const auto found = objects_.find(number);
        if (found == objects_.end() || version <= found->second.history.newest()) continue;
        Object& object = found->second;
        object.history.announce(version, currentFrame_);
        if (object.share.delivery == Delivery::Push) request(object, version, nowNs);
    }
}

void ObjectMirror::requestBlobs(const ObjectState& state, int64_t nowNs) {
    for (const auto& slot : state.slots)
        for (const auto& entry : slot->blobs)
            if (!entry->isHere) blobs_.request(entry, nowNs);
}

void ObjectMirror::apply(const OfferMessage& message, int64_t nowNs) {
    const auto found = objects_.find(message.number);
    if (found == objects_.end()) return noteEarly(message.number, message.version);
    Object& object = found->second;
    if (message.version == 0) return;
    object.history.announce(message.version, currentFrame_);
    if (object.share.sharing == Sharing::Unbuffered) object.history.keepNewest();
    if (object.history.size() > 1) aged_.insert(message.number);
    if (object.wanted != 0) request(object, std::max(object.wanted, Version{1}), nowNs);
}

void ObjectMirror::apply(const UnshareMessage& message) {
    const auto found = objects_.find(message.number);
    if (found == objects_.end()) return noteEarly(message.number, 0);
    found->second.endFrame = std::min(found->second.endFrame, currentFrame_);
    if (!settle(message.number)) aged_.insert(message.number);
}

Result<void> ObjectMirror::apply(const RefuseMessage& message, int64_t nowNs) {
    if (message.reason == Refusal::UnknownBlob) return blobs_.input(message, nowNs);
    const auto found = objects_.find(message.number);
    if (found == objects_.end()) return {};
    Object& object = found->second;
    if (object.wanted == 0 || object.wanted > message.version) return {}; // of an earlier request
    object.refused = std::max(object.refused, message.version);
    object.wanted = 0;
    if (object.share.delivery == Delivery::Push) return {}; // a newer version follows
    return Error{describe(object.share) + ": the writer no longer has version " + std::to_string(message.version) +
                 "; use a newer reference, or share it with more keptVersions"};
}

void ObjectMirror::request(Object& object, Version version, int64_t nowNs) {
    const bool isUnderWay =
        object.wanted != 0 && object.wanted >= version && nowNs - object.wantedNs < BlobIntake::kRetryNs;
    if (isUnderWay) return;
    object.wanted = std::max(object.wanted, version);
    object.wantedNs = nowNs;
    const StatePointer newest = object.history.newestState();
    const Version have = newest && newest->version <= object.wanted ? newest->version : 0;
    sender_.toOne(kWriter, WantMessage{object.share.number, object.wanted, have});
}

void ObjectMirror::tick(int64_t nowNs) {
    blobs_.tick(nowNs);
    for (auto& [number, object] : objects_)
        if (object.wanted != 0) request(object, object.wanted, nowNs);
}

void ObjectMirror::frame(uint64_t number) { currentFrame_ = number + 1; }

bool ObjectMirror::settle(ObjectNumber number) {
    const auto found = objects_.find(number);
    if (found == objects_.end()) return true;
    Object& object = found->second;
    if (object.endFrame > finishedFrame_ + 1) {
        object.history.trim(finishedFrame_, object.share.keptVersions);
        return object.history.size() <= 1 && object.endFrame == UINT64_MAX;
    }
    const auto known = numbers_.find(object.share.id);
    if (known != numbers_.end() && known->second == number) numbers_.erase(known);
    const auto named = names_.equal_range(object.share.name);
    const auto name = std::find_if(named.first, named.second, [&](const auto& item) { return item.second == number; });
    if (name != named.second) names_.erase(name);
    objects_.erase(found);
    return true;
}

void ObjectMirror::frameDone(uint64_t number) {
    finishedFrame_ = std::max(finishedFrame_, number);
    std::erase_if(aged_, [this](ObjectNumber object) { return settle(object); });
}

const ObjectMirror::Object* ObjectMirror::objectOf(const Uuid& id) const {
    const auto number = numbers_.find(id);
    if (number == numbers_.end()) return nullptr;
    const auto object = objects_.find(number->second);
    return object == objects_.end() ? nullptr : &object->second;
}

ObjectMirror::Found ObjectMirror::found(const Object& object, Version version) const {
    Found result;
    result.share = &object.share;
    result.presence = Presence::Waiting;
    const VersionHistory& history = object.history;
    if (version == 0) version = history.newest();
    if (version == 0) return result;
    StatePointer state = history.at(version);
    if (!state && object.share.sharing == Sharing::Unbuffered && history.newestState() &&
        history.newestState()->version > version)
        state = history.newestState(); // older versions are not kept
    if (state) {
        if (!state->isComplete()) return result;
        result.presence = Presence::Here;
        result.state = std::move(state);
    } else if (version <= object.refused) {
        result.presence = Presence::Refused;
    } else if (object.share.delivery == Delivery::Push && version < history.oldest()) {
        result.presence = Presence::Gone;
    }
    return result;
}

ObjectMirror::Found ObjectMirror::find(const AnyRef& ref) const {
    const Object* const object = objectOf(ref.id);
    return object ? found(*object, ref.version) : Found{};
}

ObjectMirror::Found ObjectMirror::findAtFrame(const Uuid& id, uint64_t frame) const {
    const Object* const object = objectOf(id);
    if (!object || frame >= object->endFrame) return {};
    if (object->share.sharing == Sharing::Unbuffered) return found(*object, 0);
    const Version version = object->history.versionAtFrame(frame);
    if (version > 0) return found(*object, version);
    Found result;
    result.share = &object->share;
    result.presence = object->history.empty() ? Presence::Waiting : Presence::Gone;
    return result;
}

Version ObjectMirror::versionAtFrame(const Uuid& id, uint64_t frame) const {
    const Object* const object = objectOf(id);
    return object ? object->history.versionAtFrame(frame) : 0;
}

// Types of equal layout differ by their names.
const ShareMessage* ObjectMirror::shareOf(std::string_view name, const archive::TypeLayout& layout,
                                          uint64_t frame) const {
    const std::string_view typeName = std::string_view(layout.typeName).substr(0, kMaxNameBytes);
    const auto range = names_.equal_range(name);
    const ShareMessage* best = nullptr;
    for (auto at = range.first; at != range.second; ++at) {
        const auto object = objects_.find(at->second);
        if (object == objects_.end() || frame >= object->second.endFrame) continue;
        const ShareMessage& share = object->second.share;
        if (share.typeName != typeName) continue;
        if (share.layoutHash == layout.hash) return &share;
        best = &share;
    }
    return best;
}

std::string ObjectMirror::typesNamed(std::string_view name) const {
    std::string types;
    const auto range = names_.equal_range(name);
    for (auto at = range.first; at != range.second; ++at) {
        const auto object = objects_.find(at->second);
        if (object != objects_.end()) types += (types.empty() ? "" : ", ") + object->second.share.typeName;
    }
    return types;
}

void ObjectMirror::want(const AnyRef& ref, int64_t nowNs) {
    const auto number = numbers_.find(ref.id);
    if (number == numbers_.end()) return;
    Object& object = objects_[number->second];
    const Version version = ref.version != 0 ? ref.version : std::max(object.history.newest(), Version{1});
    if (version <= object.refused) return;
    if (const StatePointer state = object.history.at(version)) {
        requestBlobs(*state, nowNs);
    } else if (object.share.delivery == Delivery::OnDemand) {
        request(object, version, nowNs);
    }
}

} // namespace mural::objects
