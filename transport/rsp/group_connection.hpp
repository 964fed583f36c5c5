// A group as Connection and Listener. Each connection reads one member's stream; writes reach all members. All
// connections of a host share its group, which ends with the last connection and the listener. A member that closes its
// connection leaves; a host that closes a connection evicts the member. Written data has one second to arrive before.
//
// Source: thesis, section "Reliable Stream Protocol": a member is an accepted connection.
#pragma once

#include <memory>
#include <vector>

#include "transport/connection.hpp"
#include "transport/rsp/group.hpp"

namespace mural::rsp {

// Joins a group and reads the host's stream. Errors: no host, wrong secret, deadline.
Result<std::unique_ptr<Connection>> joinGroup(const GroupOptions& options, Deadline deadline);
// Returns a connection to the host's stream. `first`: bytes already read, returned first.
std::unique_ptr<Connection> streamOfHost(std::unique_ptr<Group> group, const GroupOptions& options,
                                         std::vector<std::byte> first);
// Hosts a group. accept() returns each member after its stream has begun; describe() contains the control address for
// members.
Result<std::unique_ptr<Listener>> hostGroup(const GroupOptions& options);

} // namespace mural::rsp
