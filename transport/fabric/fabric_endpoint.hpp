// One connected endpoint of libfabric with its registered buffers and completion queue: sends and receives messages in
// slots of one piece of memory. Knows nothing of what they say.
// Threads: one at a time, but for sleep(): another may use the endpoint meanwhile, and wake() it.
#pragma once

#include <array>
#include <cstddef>
#include <rdma/fi_cm.h>
#include <rdma/fi_domain.h>
#include <rdma/fi_endpoint.h>
#include <span>
#include <string>

#include "transport/fabric/fabric_events.hpp"
#include "transport/fabric/fabric_message.hpp"
#include "transport/file_descriptor.hpp"

namespace mural::fabric {

class Endpoint {
public:
    // Slots from 0 on receive, from kReceives on they send.
    using Slot = size_t;
    struct Completion {
        Slot slot = 0;
        size_t sizeBytes = 0; // of what was received
    };

    // Opens it and has all its receiving slots ready; not yet connected.
    static Result<std::unique_ptr<Endpoint>> open(const SharedFabric& fabric, fi_info& info);
    ~Endpoint();

    // Each waits until it is connected. Who connects learns what the other end may be sent; who accepts knows from the request.
    Result<Greeting> connect(Deadline deadline);
    Result<void> accept(Deadline deadline);

    [[nodiscard]] std::span<std::byte> memory(Slot slot) { return {memory_.get() + slot * kMessageBytes, kMessageBytes}; }
    // 0, or an error; -FI_EAGAIN: later.
    long receive(Slot slot);
    long send(Slot slot, size_t sizeBytes);
    long inject(const Head& head); // its bytes are taken at once, and complete unheard

    // How many of `into` were filled; negative: the connection is broken, code says why.
    int completions(std::span<Completion> into, long& code);
    // Whether the connection was ended by the other end or broke.
    bool shutDownMeanwhile();
    void shutDown() { fi_shutdown(endpoint_.get(), 0); }

    // True when there may be sleep: nothing came since the last look. Then sleep() waits for something to come;
    // true: look for events, such as the end, too.
    bool mayExpectWakeUp();
    bool sleep(Deadline deadline);
    void wake();

    [[nodiscard]] std::string peerText(const std::string& otherwise) const;

private:
    struct FreeBytes {
        void operator()(std::byte* bytes) const { ::free(bytes); }
    };
    struct Context {
        fi_context2 context{}; // the provider's while an operation is under way
    };

    Endpoint() = default;
    Result<void> openQueue(fid_domain* domain);
    Result<void> openMemory(fid_domain* domain);
    Result<void> openEndpoint(fid_domain* domain, fi_info& info);
    Result<std::vector<std::byte>> awaitConnected(Deadline deadline);

    // In the order in which they are opened: closed the other way round.
    SharedFabric fabric_;
    std::string provider_;
    std::vector<std::byte> address_; // to connect to
    EventQueue events_;
    Handle<fid_domain> domain_;
    Handle<fid_cq> queue_;
    int queueDescriptor_ = -1;
    std::unique_ptr<std::byte[], FreeBytes> memory_;
    Handle<fid_mr> registered_;
    Handle<fid_ep> endpoint_;
    std::array<Context, kReceives + kSends> contexts_{};
    FileDescriptor wake_;
};

} // namespace mural::fabric
