// Messages between a head and the process that forks its local nodes, over a SOCK_SEQPACKET pair. A request is one byte
// with the descriptor of the node's shared memory. Both ends are the same executable, so there is no version.
#pragma once

#include <cstdint>

namespace mural {

struct ForkReply {
    enum class Kind : int32_t {
        Forked, // value: pid of the new node
        Failed, // value: errno
        Ended,  // value: status of the node as waitpid() returns it
    };
    Kind kind = Kind::Failed;
    uint32_t node = 0; // number of the request, from 0; pids are reused
    int32_t value = 0;
};

} // namespace mural
