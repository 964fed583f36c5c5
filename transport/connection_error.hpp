// Error texts of failed reads and writes, common to all connections.
#pragma once

#include <cstddef>
#include <string>

#include "common/base/result.hpp"

namespace mural {

namespace ending {
inline constexpr const char* kPeerGone = "the peer has closed the connection; see its messages";
inline constexpr const char* kClosedHere = "closed by this end";
inline constexpr const char* kIdle = "deadline passed, the peer is idle or slow; try again later";
inline constexpr const char* kCutInHalf = "deadline passed within a message, the connection is closed; connect again";
} // namespace ending

// Returns "tcp://wall1:4711 read, 3 of 8 bytes done: the other end is gone; ...".
inline Error connectionError(const std::string& description, const char* verb, size_t doneBytes, size_t wantedBytes,
                             const std::string& reason) {
    return Error{description + " " + verb + ", " + std::to_string(doneBytes) + " of " + std::to_string(wantedBytes) +
                 " bytes: " + reason};
}

} // namespace mural
