#include "native/runtime/client_objects.hpp"

#include <utility>

#include "common/base/clock.hpp"

namespace mural::native {

ClientObjects::ClientObjects(uint32_t node, Send send, Await await) : node_(node), send_(std::move(send)), end_(*this) {
    if (await) end_.waitBy(std::move(await));
}

Result<void> ClientObjects::input(std::span<const std::byte> arguments) {
    if (!joiner_.add(arguments)) return Error{"a record about objects is malformed; install one version of libmural"};
    if (!joiner_.isComplete() || (joiner_.node() != wire::kAllNodes && joiner_.node() != node_)) return {};
    return end_.input(joiner_.message(), monotonicNowNs());
}

} // namespace mural::native
