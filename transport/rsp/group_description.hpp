// A multicast group as text: rsp://group:port?parameter=value&…
//
//   control=HOST:PORT     where the group's host listens (host: :0, any free port)
//   secret=FILE           with at least 16 bytes, - for standard input; without it only `secretOf` others can fill it in
//   interface=NAME        network interface, by name or by one of its addresses
//   rate=900mbit          at most; 0: nine tenths of what the card tells
//   seal=auto             encryption: auto, aes-256-gcm, chacha20-poly1305, siphash (proves, hides nothing), none
//   datagram=1472         bytes of UDP payload; 0: what the card's packets hold
//   window=4096           datagrams
//   socket=8M             bytes of the sockets' buffers
//   stalled=eject|wait    what is done about a member that all wait for, after
//   stalled-ms=2000
//   silent-ms=1000        how long a member may say nothing
//   probe-ms=300          how long a member may take to see multicast
//   parity=on|off         off: what is lost is sent again
//   multicast=on|off      off: this member is reached by its control connection alone
//   name=member           by which the host knows this member
#pragma once

#include "transport/connection_description.hpp"
#include "transport/rsp/group.hpp"

namespace mural::rsp {

// Errors name the parameter and say what is allowed.
Result<GroupOptions> groupOptionsOf(const ConnectionDescription& description);

} // namespace mural::rsp
