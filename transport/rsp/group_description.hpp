// Text form of a multicast group: rsp://group:port?parameter=value&...
//
//   control=HOST:PORT     listening address of the group's host (host: ":0" for any free port)
//   secret=FILE           at least 16 bytes; "-": standard input; without it only `secretOf` can supply it
//   interface=NAME        network interface, by name or address
//   rate=900mbit          maximum rate; 0: nine tenths of the interface's rate
//   seal=auto             encryption: auto, aes-256-gcm, chacha20-poly1305, siphash (authentication only), none
//   datagram=1472         UDP payload in bytes; 0: from the interface's MTU
//   window=4096           in datagrams
//   socket=8M             size of the socket buffers in bytes
//   stalled=eject|wait    action for a member that stalls all others
//   stalled-ms=2000       time after which a member counts as stalled
//   silent-ms=1000        eviction timeout
//   probe-ms=300          timeout of the multicast probe
//   parity=on|off         off: retransmits datagrams instead of parity
//   multicast=on|off      off: this member uses its control connection only
//   name=member           name by which the host knows this member
#pragma once

#include "transport/connection_description.hpp"
#include "transport/rsp/group.hpp"

namespace mural::rsp {

// Errors name the parameter and its valid values.
Result<GroupOptions> groupOptionsOf(const ConnectionDescription& description);

} // namespace mural::rsp
