// One connected libfabric endpoint with registered buffers and a completion queue. Sends and receives messages in slots
// of one memory block, without interpreting them. Thread safety: one thread at a time, except during sleep(): another
// may use the endpoint then, and wake() it.
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
#include "common/ipc/file_descriptor.hpp"

namespace mural::fabric {

class Endpoint {
public:
    // Slots from 0 on receive; slots from kReceives on send.
    using Slot = size_t;
    struct Completion {
        Slot slot = 0;
        size_t sizeBytes = 0; // of the received message
    };

    // Opens an endpoint with all receive slots posted, not connected yet.
    static Result<std::unique_ptr<Endpoint>> open(const SharedFabric& fabric, fi_info& info);
    ~Endpoint();

    // Both block until connected. The connecting end learns the peer's limits; the accepting end knows them from the
    // request.
    Result<Greeting> connect(Deadline deadline);
    Result<void> accept(Deadline deadline);

    [[nodiscard]] std::span<std::byte> memory(Slot slot) {
        return {memory_.get() + slot * kMessageBytes, kMessageBytes};
    }
    // Returns 0 or an error; -FI_EAGAIN: retry later.
    long receive(Slot slot);
    long send(Slot slot, size_t sizeBytes);
    long inject(const Header& header); // copies the bytes, and completes without a completion event

    // Returns the number of entries filled; negative: the connection is broken, `code` has the reason.
    int completions(std::span<Completion> into, long& code);
    // Returns true if the peer has ended the connection, or it broke.
    bool shutDownMeanwhile();
    void shutDown() { fi_shutdown(endpoint_.get(), 0); }

    // Returns true if sleeping is safe: nothing has arrived since the last poll. sleep() then waits for an event; its
    // result true requests a check for connection events, such as the end.
    bool mayExpectWakeUp();
    bool sleep(Deadline deadline);
    void wake();

    [[nodiscard]] std::string peerText(const std::string& otherwise) const;

private:
    struct FreeBytes {
        void operator()(std::byte* bytes) const { ::free(bytes); }
    };
    struct Context {
        fi_context2 context{}; // owned by the provider during an operation
    };

    Endpoint() = default;
    Result<void> openQueue(fid_domain* domain);
    Result<void> openMemory(fid_domain* domain);
    Result<void> openEndpoint(fid_domain* domain, fi_info& info);
    Result<std::vector<std::byte>> awaitConnected(Deadline deadline);

    // In order of creation; destroyed in reverse.
    SharedFabric fabric_;
    std::string provider_;
    std::vector<std::byte> address_; // address to connect to
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
