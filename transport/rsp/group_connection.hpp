// A group as Connection and Listener. Each connection reads one member's stream; what is written goes to all members, as
// all hear the same. Several connections of a host share its group; the group ends with the last of them and the listener.
// A member that closes its connection leaves, a host that closes one removes that member; what was written is given a
// second to arrive before.
//
// Source: thesis, section "Reliable Stream Protocol": a member is a connection that is accepted.
#pragma once

#include <memory>
#include <vector>

#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural::rsp {

// Reads the host's stream. Errors: no host, a wrong secret, the deadline.
Result<std::unique_ptr<Connection>> joinGroup(const GroupOptions& options, Deadline deadline);
// The host's stream, of which `first` has been read already: it comes first.
std::unique_ptr<Connection> streamOfHost(std::unique_ptr<Group> group, const GroupOptions& options, std::vector<std::byte> first);
// accept() returns each member once its stream has begun; describe() has the control address that members need.
Result<std::unique_ptr<Listener>> hostGroup(const GroupOptions& options);

} // namespace mural::rsp
