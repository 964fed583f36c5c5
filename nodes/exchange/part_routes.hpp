// Message transport between the nodes of a picture, by rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/exchange/part_sender.hpp"

namespace mural {

class PartRoutes {
public:
    virtual ~PartRoutes() = default;

    // Does not wait for the receiver. Errors of send and receive: the peer is lost; no message before the deadline.
    // After an error the peer counts as lost, and later calls fail at once.
    virtual Result<void> send(int rank, std::vector<std::byte> message, Deadline deadline) = 0;
    // Returns the next message of the rank. A message above maxBytes is an error.
    virtual Result<std::vector<std::byte>> receive(int rank, size_t maxBytes, Deadline deadline) = 0;
    // The transfer to that rank since the last call.
    virtual LinkTransfer takeTransfer(int rank) = 0;
    // Drops a peer that has sent an invalid message.
    virtual void giveUp(int rank) = 0;
    // Replaces the node of that rank by this incarnation. Without a connection the rank counts as lost.
    virtual void renew(int rank, uint32_t incarnation) = 0;
};

} // namespace mural
