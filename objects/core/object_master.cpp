#include "objects/core/object_master.hpp"

#include <algorithm>
#include <bit>

#include "objects/core/object_names.hpp"

namespace mural::objects {

namespace {

constexpr size_t kMaxValueBytes = UINT32_MAX;

} // namespace

bool ObjectMaster::keeps(const Object& object) const {
    return options_.keepsPushed || object.share.delivery == Delivery::OnDemand;
}

Result<ObjectNumber> ObjectMaster::share(const ObjectDescription& description) {
    const ShareOptions& options = description.options;
    if (options.name.size() > kMaxNameBytes)
        return Error{"cannot share object \"" + options.name.substr(0, 32) + "...\": its name has " +
                     std::to_string(options.name.size()) + " bytes; use at most " + std::to_string(kMaxNameBytes)};
    if (objects_.size() >= kMaxObjects)
        return Error{"cannot share object \"" + options.name + "\": " + std::to_string(kMaxObjects) +
                     " objects are shared already; combine small objects"};
    const ObjectNumber number = next_++;
    Object& object = objects_[number];
    object.share = {number,
                    description.id,
                    options.sharing,
                    options.delivery,
                    options.keptVersions,
                    options.mostUnread,
                    archive::slotsOf(description.layout.fieldCount),
                    description.layout.hash,
                    options.name,
                    description.layout.typeName.substr(0, kMaxNameBytes),
                    description.layout.text.substr(0, kMaxLayoutBytes)};
    if (options.mostUnread > 0 && options.delivery == Delivery::Push)
        for (const auto& [reader, name] : readers_) object.tokens[reader] = 0;
    sender_.toAll(object.share);
    return number;
}

Result<void> ObjectMaster::verify(const Object& object, const ObjectChange& change) const {
    const uint64_t all = allSlots(object.share.slotCount);
    const auto refused = [&](const std::string& problem) {
        return Error{"cannot commit " + describe(object.share) + ": " + problem};
    };
    if (object.share.sharing == Sharing::Static && object.version > 0)
        return refused("it is static and has been committed; share it with Sharing::Delta to change it");
    const bool isWhole = object.version == 0 || object.share.sharing != Sharing::Delta;
    if ((change.slots & ~all) != 0 || (isWhole && change.slots != all) ||
        change.values.size() != static_cast<size_t>(std::popcount(change.slots)))
        return refused("the values do not match its fields");
    uint64_t sum = 0;
    for (const auto& value : change.values) {
        if (value.bytes.size() > kMaxValueBytes)
            return refused("a field has " + std::to_string(value.bytes.size()) +
                           " bytes; use mural::Blob for 4 GiB and more");
        sum += value.bytes.size();
    }
    if (sum > options_.mostCommitBytes)
        return refused("its changed fields have " + std::to_string(sum) + " bytes, of at most " +
                       std::to_string(options_.mostCommitBytes) + "; use mural::Blob for large data");
    return {};
}

std::shared_ptr<BlobEntry> ObjectMaster::entryFor(const Blob& blob) {
    std::weak_ptr<BlobEntry>& known = blobs_[blob.name()];
    std::shared_ptr<BlobEntry> entry = known.lock();
    if (entry) return entry;
    entry = std::make_shared<BlobEntry>(BlobEntry{{blob.name(), blob.sizeBytes()}, blob, true});
    known = entry;
    if (blobs_.size() >= sweepAt_) {
        std::erase_if(blobs_, [](const auto& item) { return item.second.expired(); });
        sweepAt_ = std::max<size_t>(64, 2 * blobs_.size());
    }
    return entry;
}

StatePointer ObjectMaster::makeState(const Object& object, const ObjectChange& change, const ObjectState* before) {
    auto state = std::make_shared<ObjectState>();
    state->version = object.version + 1;
    if (before) state->slots = before->slots;
    state->slots.resize(object.share.slotCount);
    size_t next = 0;
    for (uint32_t i = 0; i < object.share.slotCount; ++i) {
        if ((change.slots >> i & 1) == 0) continue;
        const auto& value = change.values[next++];
        auto slot = std::make_shared<Slot>();
        if (keeps(object)) slot->bytes.assign(value.bytes.begin(), value.bytes.end());
        for (const Blob& blob : value.blobs) slot->blobs.push_back(entryFor(blob));
        state->slots[i] = std::move(slot);
    }
    return state;
}

void ObjectMaster::pushBlobs(const Slot& slot) {
    for (const auto& entry : slot.blobs)
        if (pushes_[entry->ref.name]++ == 0)
            sendBlob(entry->blob, options_.blobs, [this](std::span<const std::byte> message) { sink_.toAll(message); });
}

void ObjectMaster::releasePushes(const Slot& slot) {
    for (const auto& entry : slot.blobs)
        if (const auto found = pushes_.find(entry->ref.name); found != pushes_.end() && --found->second == 0)
            pushes_.erase(found);
}

void ObjectMaster::retire(std::shared_ptr<const Slot> slot) {
    if (!slot->blobs.empty() && (currentFrame_ > 1 || options_.hasFrames))
        retired_.emplace_back(currentFrame_, std::move(slot));
}

Result<Version> ObjectMaster::commit(ObjectNumber number, const ObjectChange& change) {
    const auto found = objects_.find(number);
    if (found == objects_.end())
        return Error{"cannot commit object number " + std::to_string(number) + ": it is not shared; share it first"};
    Object& object = found->second;
    if (const auto verified = verify(object, change); !verified) return verified.error();
    const StatePointer before = object.history.newestState();
    const StatePointer state = makeState(object, change, before.get());
    const bool isPushed = object.share.delivery == Delivery::Push;
    if (isPushed)
        for (uint32_t i = 0; i < object.share.slotCount; ++i)
            if ((change.slots >> i & 1) != 0) pushBlobs(*state->slots[i]);
    const Version base = change.slots == allSlots(object.share.slotCount) ? 0 : object.version;
    object.version = state->version;
    object.history.add(state->version, currentFrame_, state);
    deliver(object, change, base);
    if (before) {
        for (uint32_t i = 0; i < object.share.slotCount; ++i) {
            if ((change.slots >> i & 1) == 0) continue;
            if (isPushed) releasePushes(*before->slots[i]);
            retire(before->slots[i]);
        }
    }
    if (object.share.sharing == Sharing::Unbuffered) {
        object.history.keepNewest();
    } else if (object.history.size() > 1) {
        object.history.trim(finishedFrame_, object.share.keptVersions);
        aged_.insert(number);
    }
    return object.version;
}

void ObjectMaster::deliver(const Object& object, const ObjectChange& change, Version base) {
    const bool isPushed = object.share.delivery == Delivery::Push;
    if (!isPushed) sender_.toAll(OfferMessage{object.share.number, object.version});
    if (!isPushed && object.holders.empty()) return;
    CommitMessage message{object.share.number, object.version, base, change.slots, {}};
    message.values.reserve(change.values.size());
    for (const auto& value : change.values) {
        SlotValue& slot = message.values.emplace_back();
        slot.bytes = value.bytes;
        for (const Blob& blob : value.blobs) slot.blobs.push_back({blob.name(), blob.sizeBytes()});
    }
    if (isPushed) return sender_.toAll(message);
    for (const PeerId holder : object.holders) sender_.toOne(holder, message);
}

void ObjectMaster::unshare(ObjectNumber number) {
    const auto found = objects_.find(number);
    if (found == objects_.end()) return;
    sender_.toAll(UnshareMessage{number});
    if (const StatePointer state = found->second.history.newestState()) {
        for (const auto& slot : state->slots) {
            if (found->second.share.delivery == Delivery::Push) releasePushes(*slot);
            retire(slot);
        }
    }
    aged_.erase(number);
    objects_.erase(found);
}

std::optional<std::string> ObjectMaster::readerBehind(ObjectNumber number) const {
    const auto found = objects_.find(number);
    if (found == objects_.end() || found->second.share.mostUnread == 0) return std::nullopt;
    const Object& object = found->second;
    for (const auto& [reader, version] : object.tokens) {
        if (object.version < version + object.share.mostUnread) continue;
        const auto name = readers_.find(reader);
        return name == readers_.end() ? "reader " + std::to_string(reader) : name->second;
    }
    return std::nullopt;
}

Version ObjectMaster::versionOf(ObjectNumber number) const {
    const auto found = objects_.find(number);
    return found == objects_.end() ? 0 : found->second.version;
}

void ObjectMaster::join(PeerId reader, const std::string& name) {
    readers_[reader] = name;
    for (auto& [number, object] : objects_)
        if (object.share.mostUnread > 0 && object.share.delivery == Delivery::Push)
            object.tokens[reader] = object.version;
    if (!options_.keepsPushed) return;
    CatalogueWriter writer(BlobTransfer::Bytes,
                           [&](std::span<const std::byte> message) { sink_.toOne(reader, message); });
    for (const auto& [number, object] : objects_)
        writer.add(object.share, object.history.newestState(), object.version);
    writer.end();
}

void ObjectMaster::leave(PeerId reader) {
    readers_.erase(reader);
    for (auto& [number, object] : objects_) {
        object.holders.erase(reader);
        object.tokens.erase(reader);
    }
    for (auto& [key, gathered] : wantedObjects_) gathered.askers.erase(reader);
    for (auto& [key, gathered] : wantedBlobs_) gathered.askers.erase(reader);
}

void ObjectMaster::frameDone(uint64_t number) {
    finishedFrame_ = std::max(finishedFrame_, number);
    while (!retired_.empty() && retired_.front().first <= finishedFrame_) retired_.pop_front();
    for (auto at = aged_.begin(); at != aged_.end();) {
        Object& object = objects_.at(*at);
        object.history.trim(finishedFrame_, object.share.keptVersions);
        at = object.history.size() <= 1 ? aged_.erase(at) : std::next(at);
    }
}

uint64_t ObjectMaster::keptBytes() const {
    uint64_t sum = 0;
    std::set<const Slot*> counted;
    for (const auto& [number, object] : objects_)
        for (const auto& entry : object.history.entries())
            for (const auto& slot : entry.state->slots)
                if (counted.insert(slot.get()).second) sum += slot->bytes.size();
    return sum;
}

} // namespace mural::objects
