#include "transport/fabric/fabric_events.hpp"

#include <algorithm>
#include <cstring>
#include <rdma/fi_cm.h>

#include "transport/tcp/socket_wait.hpp"

namespace mural::fabric {

namespace {

constexpr size_t kMaxDataBytes = 256; // largest data of a connection request
constexpr int64_t kPollSliceMs = 100; // some providers progress only when polled

struct alignas(fi_eq_cm_entry) EventBytes {
    std::byte bytes[sizeof(fi_eq_cm_entry) + kMaxDataBytes];
};

Event::Kind kindOf(uint32_t event) {
    switch (event) {
    case FI_CONNREQ: return Event::Kind::Request;
    case FI_CONNECTED: return Event::Kind::Connected;
    case FI_SHUTDOWN: return Event::Kind::Shutdown;
    default: return Event::Kind::None;
    }
}

} // namespace

Result<EventQueue> EventQueue::open(const SharedFabric& fabric) {
    EventQueue queue;
    queue.fabric_ = fabric;
    fi_eq_attr attributes{};
    attributes.wait_obj = FI_WAIT_FD;
    fid_eq* made = nullptr;
    int code = fi_eq_open(fabric.get(), &attributes, &made, nullptr);
    if (code == 0) {
        queue.queue_.reset(made);
        code = fi_control(&made->fid, FI_GETWAIT, &queue.descriptor_);
    }
    if (code != 0)
        return Error{"fabric: cannot open an event queue with a descriptor: " + codeText(code) +
                     "; try another provider"};
    return queue;
}

Event EventQueue::poll() {
    EventBytes room{};
    uint32_t what = 0;
    const ssize_t got = fi_eq_read(queue_.get(), &what, room.bytes, sizeof room.bytes, 0);
    Event event;
    if (got >= 0) {
        event.kind = kindOf(what);
        fi_eq_cm_entry entry{};
        std::memcpy(&entry, room.bytes, std::min(sizeof entry, static_cast<size_t>(got)));
        if (event.kind == Event::Kind::Request) event.info.reset(entry.info);
        const std::byte* data = room.bytes + sizeof entry;
        if (static_cast<size_t>(got) > sizeof entry)
            event.greeting.assign(data, static_cast<const std::byte*>(room.bytes) + got);
    } else if (got == -FI_EAVAIL) {
        fi_eq_err_entry why{};
        fi_eq_readerr(queue_.get(), &why, 0);
        event.kind = Event::Kind::Failed;
        event.code = why.err;
    } else if (got != -FI_EAGAIN) {
        event.kind = Event::Kind::Failed;
        event.code = got;
    }
    return event;
}

Event EventQueue::next(Deadline deadline) {
    while (true) {
        Event event = poll();
        if (event.kind != Event::Kind::None || deadline.passed()) return event;
        fid* waited = &queue_->fid;
        if (fi_trywait(fabric_.get(), &waited, 1) != 0) continue;
        const int64_t leftMs = deadline.leftNs(kPollSliceMs * kNsPerMs) / kNsPerMs + 1;
        waitForSocket(descriptor_, POLLIN, Deadline::inMs(leftMs));
    }
}

} // namespace mural::fabric
