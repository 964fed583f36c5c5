// Connects over lossy networks: the kernel repeats a lost connection request only after a second.
#pragma once

#include <span>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "transport/tcp/tcp_address.hpp"

namespace mural {

// Starts an attempt every 200 ms, alternating between the addresses; the first answer wins and the others are
// abandoned. Fails immediately if every address refuses.
Result<FileDescriptor> connectRacing(std::span<const TcpAddress> addresses, Deadline deadline);

} // namespace mural
