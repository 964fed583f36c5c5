// Requests of readers: versions of objects, ranges of blobs, tokens.
#include <algorithm>

#include "objects/core/object_master.hpp"
#include "objects/core/object_names.hpp"

namespace mural::objects {

Result<void> ObjectMaster::input(PeerId reader, std::span<const std::byte> bytes, int64_t nowNs) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    if (const auto* wanted = std::get_if<WantMessage>(&*message)) return want(reader, *wanted, nowNs);
    if (const auto* wanted = std::get_if<WantBlobMessage>(&*message)) return wantBlob(reader, *wanted, nowNs);
    const auto* const token = std::get_if<TokenMessage>(&*message);
    if (!token) return unexpectedMessage(*message, "the writer of objects");
    const auto found = objects_.find(token->number);
    if (found == objects_.end()) return {};
    Object& object = found->second;
    const auto known = object.tokens.find(reader);
    if (known == object.tokens.end()) return {};
    if (token->version > object.version)
        return Error{describe(object.share) + ": reader " + std::to_string(reader) + " acknowledges version " +
                     std::to_string(token->version) + " of " + std::to_string(object.version) + "; it is ignored"};
    known->second = std::max(known->second, token->version);
    return {};
}

Result<void> ObjectMaster::want(PeerId reader, const WantMessage& message, int64_t nowNs) {
    const auto found = objects_.find(message.number);
    if (found == objects_.end()) {
        sender_.toOne(reader, RefuseMessage{Refusal::UnknownObject, message.number, message.version, {}});
        return {};
    }
    Object& object = found->second;
    if (object.share.delivery == Delivery::OnDemand) {
        object.holders.insert(reader);
        if (object.share.mostUnread > 0) object.tokens.try_emplace(reader, object.version);
    }
    if (options_.gatherNs == 0) {
        answerObject(message.number, message.version, {{reader, message.have}});
        return {};
    }
    Gathered& gathered = wantedObjects_[{message.number, message.version}];
    if (gathered.askers.empty()) gathered.dueNs = nowNs + options_.gatherNs;
    gathered.askers[reader] = message.have;
    return {};
}

Result<void> ObjectMaster::wantBlob(PeerId reader, const WantBlobMessage& message, int64_t nowNs) {
    if (message.takesPlace) {
        const auto found = blobs_.find(message.name);
        const std::shared_ptr<BlobEntry> entry = found == blobs_.end() ? nullptr : found->second.lock();
        if (const auto place = entry ? placeOf(entry->blob) : std::nullopt) {
            sender_.toOne(reader, BlobAtMessage{*place});
            return {};
        }
    }
    const BlobRange range{message.name, {message.offset, message.count}};
    if (options_.gatherNs == 0) {
        answerBlob(range, {nowNs, {{reader, 0}}, message.bytesPerSecond});
        return {};
    }
    Gathered& gathered = wantedBlobs_[range];
    const bool isFirst = gathered.askers.empty();
    if (isFirst) gathered.dueNs = nowNs + options_.gatherNs;
    gathered.bytesPerSecond =
        isFirst ? message.bytesPerSecond : std::min(gathered.bytesPerSecond, message.bytesPerSecond);
    gathered.askers[reader] = 0;
    return {};
}

void ObjectMaster::tick(int64_t nowNs) {
    for (auto at = wantedObjects_.begin(); at != wantedObjects_.end();) {
        if (at->second.dueNs > nowNs) {
            ++at;
            continue;
        }
        answerObject(at->first.first, at->first.second, at->second.askers);
        at = wantedObjects_.erase(at);
    }
    for (auto at = wantedBlobs_.begin(); at != wantedBlobs_.end();) {
        if (at->second.dueNs > nowNs) {
            ++at;
            continue;
        }
        answerBlob(at->first, at->second);
        at = wantedBlobs_.erase(at);
    }
}

void ObjectMaster::emitTo(const std::map<PeerId, Version>& askers, std::span<const std::byte> message) {
    if (askers.empty()) return;
    if (askers.size() > 1) return sink_.toAll(message);
    sink_.toOne(askers.begin()->first, message);
}

void ObjectMaster::answerObject(ObjectNumber number, Version wanted, const std::map<PeerId, Version>& askers) {
    const auto found = objects_.find(number);
    const bool isServed = found != objects_.end() && keeps(found->second);
    if (!isServed) {
        const Refusal reason = found == objects_.end() ? Refusal::UnknownObject : Refusal::GoneVersion;
        return emitTo(askers, encode(RefuseMessage{reason, number, wanted, {}}).bytes());
    }
    const VersionHistory& history = found->second.history;
    const StatePointer newest = history.newestState();
    if (!newest || askers.empty()) return; // not committed yet; the reader asks again
    // Several readers may have different versions, so they receive whole states.
    StatePointer base = askers.size() == 1 ? history.at(askers.begin()->second) : nullptr;
    const StatePointer exact = history.at(wanted);
    if (exact && base && base->version >= exact->version) base = nullptr;
    if (exact) emitTo(askers, encode(commitOf(number, *exact, base.get())).bytes());
    if (exact == newest) return;
    const bool isGone = !exact && wanted != 0 && wanted < newest->version;
    if (isGone && found->second.share.sharing != Sharing::Unbuffered)
        emitTo(askers, encode(RefuseMessage{Refusal::GoneVersion, number, wanted, {}}).bytes());
    if (base && base->version >= newest->version) base = nullptr;
    emitTo(askers, encode(commitOf(number, *newest, exact ? exact.get() : base.get())).bytes());
}

void ObjectMaster::answerBlob(const BlobRange& range, const Gathered& gathered) {
    const auto found = blobs_.find(range.first);
    const std::shared_ptr<BlobEntry> entry = found == blobs_.end() ? nullptr : found->second.lock();
    if (!entry) return emitTo(gathered.askers, encode(RefuseMessage{Refusal::UnknownBlob, 0, 0, range.first}).bytes());
    sendBlobBytes(entry->blob, range.second.first, range.second.second, coder_, gathered.bytesPerSecond,
                  [&](std::span<const std::byte> message) { emitTo(gathered.askers, message); });
}

} // namespace mural::objects
