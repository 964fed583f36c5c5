#include <mural/object_reader.hpp>

#include <algorithm>

#include <mural/sharing.hpp>

#include "objects/core/object_names.hpp"
#include "objects/ends/reader_core.hpp"

namespace mural {

using objects::ObjectMirror;
using objects::ObjectState;
using objects::StatePointer;

namespace {

constexpr int64_t kReaderWaitSliceNs = 50'000'000; // bounds the error of deadlines that pause with the process

// Adapts a state to the decoder.
class StateSource final : public archive::EncodedObject {
public:
    explicit StateSource(const ObjectState& state) : state_(state) {}
    [[nodiscard]] std::span<const std::byte> bytesOf(uint32_t slot) const override {
        return slot < state_.slots.size() ? std::span<const std::byte>(state_.slots[slot]->bytes)
                                          : std::span<const std::byte>();
    }
    [[nodiscard]] const Blob* find(const BlobName& name) const override {
        for (const auto& slot : state_.slots)
            for (const auto& entry : slot->blobs)
                if (entry->ref.name == name && entry->isHere) return &entry->blob;
        return nullptr;
    }

private:
    const ObjectState& state_;
};

uint64_t slotsThatDiffer(const ObjectState& state, const ObjectState& previous) {
    uint64_t slots = 0;
    for (size_t i = 0; i < state.slots.size(); ++i)
        if (i >= previous.slots.size() || state.slots[i] != previous.slots[i]) slots |= uint64_t{1} << i;
    return slots;
}

Error readError(const std::string& object, const std::string& problem) { return {"cannot read " + object + problem}; }

} // namespace

ObjectReader::Core::Lookup ObjectReader::Core::lookUp(const ObjectMirror::Found& found,
                                                      const archive::TypeOperations& type) {
    Lookup lookup;
    lookup.presence = found.presence;
    lookup.state = found.state;
    if (!found.share) return lookup;
    lookup.object = objects::describe(*found.share);
    if (found.share->layoutHash != type.layout.hash)
        lookup.problem = " as " + type.layout.typeName + ": " +
                         archive::differenceOf(type.layout.text, found.share->layout) +
                         "; build the program on all machines from the same sources";
    if (!found.state) return lookup;
    auto& known = snapshots[found.share->id];
    if (!known) known = std::make_shared<Snapshots>();
    lookup.snapshots = known;
    return lookup;
}

Result<ObjectReader::AnySnapshot> ObjectReader::Core::decode(const Lookup& lookup,
                                                             const archive::TypeOperations& type) {
    Snapshots& known = *lookup.snapshots;
    const std::lock_guard lock(known.mutex);
    if (known.type != &type) known.entries.clear();
    known.type = &type;
    for (const auto& entry : known.entries)
        if (entry.state == lookup.state) return entry.snapshot;
    const Snapshots::Entry* const previous = known.entries.empty() ? nullptr : &known.entries.back();
    const uint64_t slots = previous ? slotsThatDiffer(*lookup.state, *previous->state)
                                    : objects::allSlots(static_cast<uint32_t>(lookup.state->slots.size()));
    Result<AnySnapshot> made =
        type.decode(previous ? previous->snapshot.get() : nullptr, slots, StateSource(*lookup.state));
    if (!made)
        return Error{"cannot read " + lookup.object + " version " + std::to_string(lookup.state->version) + ": " +
                     made.error().message + "; the last good version stays in use"};
    // Snapshots leave with their states: no mirror keeps these, and no caller reads them.
    std::erase_if(known.entries, [](const auto& entry) { return entry.state.use_count() == 1; });
    known.entries.push_back({lookup.state, made.value()});
    return made;
}

void ObjectReader::Core::forgetEnded() {
    if (snapshots.size() > mirror.objectCount())
        std::erase_if(snapshots, [this](const auto& item) { return !mirror.isKnown(item.first); });
}

template <class Find>
Result<ObjectReader::AnySnapshot> ObjectReader::Core::wait(Find&& find, const archive::TypeOperations& type,
                                                           Deadline deadline) {
    using Presence = ObjectMirror::Presence;
    std::unique_lock lock(mutex);
    for (;;) {
        if (isClosed) return readError("the object", ": the session is over");
        AnyRef ref; // the version that is waited for
        const Lookup lookup = lookUp(find(ref), type);
        const std::string version = ref.version == 0 ? "" : " version " + std::to_string(ref.version);
        if (!lookup.problem.empty()) return readError(lookup.object, lookup.problem);
        if (lookup.presence == Presence::Here) {
            lock.unlock();
            return decode(lookup, type);
        }
        if (lookup.presence == Presence::Gone || lookup.presence == Presence::Refused)
            return readError(lookup.object + version,
                             ": it is no longer kept; read a newer version, or share it with more keptVersions");
        if (lookup.presence == Presence::Unknown && mirror.hasCatalogue())
            return readError("an object (" + type.layout.typeName + ")", ": it is not shared, or has ended");
        if (deadline.passed())
            return readError(lookup.object.empty() ? "an object (" + type.layout.typeName + ")"
                                                   : lookup.object + version,
                             ": it has not arrived within the deadline");
        mirror.want(ref, monotonicNowNs());
        if (receive) {
            lock.unlock();
            const bool mayArrive = receive(Deadline::inMs(deadline.leftNs(kReaderWaitSliceNs) / kNsPerMs + 1));
            lock.lock();
            mirror.tick(monotonicNowNs());
            if (!mayArrive) return readError(lookup.object + version, ": no more messages arrive");
            continue;
        }
        arrival.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kReaderWaitSliceNs)));
    }
}

Result<ObjectReader::AnySnapshot> ObjectReader::getAny(const AnyRef& ref, const archive::TypeOperations& type,
                                                       Deadline deadline) {
    if (ref.isNull()) return readError("an object (" + type.layout.typeName + ")", ": the reference is null");
    return core_->wait(
        [&](AnyRef& wanted) {
            wanted = ref;
            return core_->mirror.find(ref);
        },
        type, deadline);
}

ObjectReader::AnySnapshot ObjectReader::peekAny(const AnyRef& ref, const archive::TypeOperations& type) {
    std::unique_lock lock(core_->mutex);
    const Core::Lookup lookup = core_->lookUp(core_->mirror.find(ref), type);
    if (!lookup.problem.empty() || core_->isClosed) return nullptr;
    if (lookup.presence != ObjectMirror::Presence::Here) {
        core_->mirror.want(ref, monotonicNowNs());
        return nullptr;
    }
    lock.unlock();
    auto snapshot = Core::decode(lookup, type);
    return snapshot ? snapshot.value() : nullptr;
}

Result<ObjectReader::AnySnapshot> ObjectReader::stateAtAny(uint64_t frame, const AnyRef& ref,
                                                           const archive::TypeOperations& type, Deadline deadline) {
    return core_->wait(
        [&](AnyRef& wanted) {
            wanted.id = ref.id;
            wanted.version = core_->mirror.versionAtFrame(ref.id, frame);
            return core_->mirror.findAtFrame(ref.id, frame);
        },
        type, deadline);
}

Result<ObjectReader::AnySnapshot> ObjectReader::stateAtAny(uint64_t frame, std::string_view name,
                                                           const archive::TypeOperations& type, Deadline deadline) {
    auto found = core_->wait(
        [&](AnyRef& wanted) -> ObjectMirror::Found {
            const objects::ShareMessage* const share = core_->mirror.shareOf(name, type.layout, frame);
            if (!share) return {};
            wanted.id = share->id;
            wanted.version = core_->mirror.versionAtFrame(share->id, frame);
            return core_->mirror.findAtFrame(share->id, frame);
        },
        type, deadline);
    if (found) return found;
    const std::lock_guard lock(core_->mutex);
    if (core_->mirror.shareOf(name, type.layout, frame) != nullptr) return found.error();
    const std::string others = core_->mirror.typesNamed(name);
    const bool isState = name.starts_with(native::kStatePrefix);
    const std::string_view own = isState ? name.substr(native::kStatePrefix.size()) : name;
    return Error{std::string("the application has no ") + (isState ? "state" : "object") + " of type " +
                 type.layout.typeName + (own.empty() ? "" : " with the name \"" + std::string(own) + "\"") +
                 (others.empty() ? "" : "; with this name it has " + others)};
}

void ObjectReader::prefetch(std::span<const AnyRef> refs) {
    const std::lock_guard lock(core_->mutex);
    if (core_->isClosed) return;
    for (const AnyRef& ref : refs) core_->mirror.want(ref, monotonicNowNs());
}

namespace objects {

ReaderEnd::ReaderEnd(MessageSink& sink, const BlobIntakeOptions& options)
    : core_(std::make_shared<ObjectReader::Core>(sink, options)), reader_(core_) {}

Result<void> ReaderEnd::input(std::span<const std::byte> message, int64_t nowNs) {
    Result<void> result;
    {
        const std::lock_guard lock(core_->mutex);
        if (!core_->isClosed) result = core_->mirror.input(message, nowNs);
    }
    core_->arrival.notify_all();
    return result;
}

void ReaderEnd::waitBy(std::function<bool(Deadline)> receive) { core_->receive = std::move(receive); }

void ReaderEnd::tick(int64_t nowNs) {
    const std::lock_guard lock(core_->mutex);
    if (!core_->isClosed) core_->mirror.tick(nowNs);
    core_->forgetEnded();
}

void ReaderEnd::frame(uint64_t number) {
    {
        const std::lock_guard lock(core_->mutex);
        core_->mirror.frame(number);
    }
    core_->arrival.notify_all();
}

void ReaderEnd::frameDone(uint64_t number) {
    const std::lock_guard lock(core_->mutex);
    core_->mirror.frameDone(number);
    core_->forgetEnded();
}

void ReaderEnd::close() {
    {
        const std::lock_guard lock(core_->mutex);
        core_->isClosed = true;
    }
    core_->arrival.notify_all();
}

} // namespace objects
} // namespace mural
