// Where the protocol puts the datagrams that it wants sent. The other side seals them and gives them to a socket, or to
// a simulated network.
#pragma once

#include "transport/rsp/datagram.hpp"

namespace mural::rsp {

class Outbox {
public:
    Outbox() = default;
    Outbox(const Outbox&) = delete;
    Outbox& operator=(const Outbox&) = delete;
    virtual ~Outbox() = default;

    // Room for one datagram of so many bytes, without the seal's tag, to the group (kEverybody) or to one member. It is
    // filled before the next call.
    virtual std::span<std::byte> datagram(MemberId to, size_t bytes) = 0;
};

} // namespace mural::rsp
