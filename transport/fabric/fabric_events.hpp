// libfabric's event queue: who asks to connect, what became of a connection.
#pragma once

#include <cstddef>
#include <rdma/fi_eq.h>
#include <vector>

#include "common/clock.hpp"
#include "common/result.hpp"
#include "transport/fabric/fabric_handle.hpp"

namespace mural::fabric {

struct Event {
    enum class Kind { None, Request, Connected, Shutdown, Failed };
    Kind kind = Kind::None;          // None: the deadline passed
    Info info;                       // of a Request
    std::vector<std::byte> greeting; // what came with a Request or Connected
    long code = 0;                   // of Failed
    [[nodiscard]] bool passing() const { return code > 0; } // Failed: one request; negative: the queue itself
};

class EventQueue {
public:
    static Result<EventQueue> open(const SharedFabric& fabric);

    // Waits for the next; a passed deadline only looks.
    Event next(Deadline deadline);
    [[nodiscard]] fid_eq* get() const { return queue_.get(); }
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    Event look();

    SharedFabric fabric_;
    Handle<fid_eq> queue_;
    int descriptor_ = -1;
};

} // namespace mural::fabric
