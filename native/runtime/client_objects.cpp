#include "native/runtime/client_objects.hpp"

#include <utility>

#include "common/base/clock.hpp"

namespace mural::native {

namespace {

objects::BlobIntakeOptions intakeOptions(bool mapsBlobs) {
    objects::BlobIntakeOptions options;
    options.requestsPlaces = mapsBlobs;
    return options;
}

} // namespace

ClientObjects::ClientObjects(Send send, const Await& await, bool mapsBlobs)
    : send_(std::move(send)), end_(*this, intakeOptions(mapsBlobs)), queues_(*this), barriers_(*this) {
    barriers_.countByFrames([this] { return drawn_; });
    if (!await) return;
    end_.waitBy(await);
    queues_.waitBy(await);
    barriers_.waitBy(await);
}

Result<void> ClientObjects::input(uint16_t receivers, std::span<const std::byte> arguments) {
    wire::ObjectRecordJoiner& joiner = receivers == wire::kToAllNodes ? toAll_ : toThisNode_;
    if (!joiner.add(arguments)) return Error{"a record about objects is malformed; install one version of libmural"};
    if (!joiner.isComplete()) return {};
    const std::span<const std::byte> message = joiner.message();
    switch (objects::kindOf(message)) {
    case objects::MessageKind::Item:
    case objects::MessageKind::Closed: return queues_.input(message, monotonicNowNs());
    case objects::MessageKind::Go:
    case objects::MessageKind::Late: return barriers_.input(message);
    default: return end_.input(message, monotonicNowNs());
    }
}

} // namespace mural::native
