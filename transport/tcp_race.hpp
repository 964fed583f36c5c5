// Connecting where datagrams get lost: the kernel repeats a lost connection request only after a second.
#pragma once

#include <span>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/file_descriptor.hpp"
#include "transport/tcp_address.hpp"

namespace mural {

// A new attempt begins every 200 ms, at the addresses by turns; the first that is answered is taken, the others are given
// up. Errors at once when every address refuses.
Result<FileDescriptor> connectRacing(std::span<const TcpAddress> addresses, Deadline deadline);

} // namespace mural
