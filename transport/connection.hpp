// A reliable, ordered, bidirectional byte stream between two processes, independent of its transport.
//
// Descriptions as text:
//   pipe:                 two ends in one process
//   shm:                  shared memory between processes of one machine (ends passed by descriptor)
//   tcp://host:port       TCP
//   rsp://group:port?...  reliable multicast (transport/rsp/group_description.hpp)
//
// Thread safety: one thread may read while another writes; neither end supports two readers or two writers. Source:
// thesis, chapter "Collage", Connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"

namespace mural {

struct NetworkPath {
    std::string ownAddress;   // numeric address of this end
    size_t datagramBytes = 0; // largest UDP payload without fragmentation, as far as both ends know
};

class Connection {
public:
    Connection() = default;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    virtual ~Connection() = default;

    // Fills all of `into`. Errors: the peer has ended, the deadline. If the deadline passes before the first byte, the
    // stream stays usable (timedOut() is true).
    virtual Result<void> read(std::span<std::byte> into, Deadline deadline) = 0;

    // Writes all of `bytes`. After an error the stream is unusable, unless the error says that nothing was written.
    virtual Result<void> write(std::span<const std::byte> bytes, Deadline deadline) = 0;

    // Makes written data visible to the peer now (a wake-up, a push); write() may delay it.
    virtual void flush() = 0;

    // Ends both directions. Blocked readers and writers on either side return with an error soon.
    virtual void close() = 0;

    [[nodiscard]] virtual bool timedOut() const = 0;
    [[nodiscard]] virtual bool alive() const = 0;
    [[nodiscard]] virtual std::string describe() const = 0;

    // Returns properties of the network path; empty for local connections.
    [[nodiscard]] virtual NetworkPath path() const { return {}; }

    // Total bytes, for the report.
    [[nodiscard]] virtual uint64_t bytesWritten() const = 0;
    [[nodiscard]] virtual uint64_t bytesRead() const = 0;
};

class Listener {
public:
    Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    virtual ~Listener() = default;
    virtual Result<std::unique_ptr<Connection>> accept(Deadline deadline) = 0;
    // Returns the description for connecting, with the actual port.
    [[nodiscard]] virtual std::string describe() const = 0;
};

// Two ends in this process.
struct PipePair {
    std::unique_ptr<Connection> a;
    std::unique_ptr<Connection> b;
};
Result<PipePair> makePipe(size_t capacityBytes = size_t{1} << 20);

// A shared-memory connection: this end, and the descriptor for the other process (inherit it by fork/exec and call
// openSharedMemory there). Capacity is per direction, a power of two.
struct SharedMemoryOffer {
    std::unique_ptr<Connection> connection;
    int peerFd = -1; // owned by the caller; close it after the child has started
};
Result<SharedMemoryOffer> offerSharedMemory(size_t capacityBytes);
Result<std::unique_ptr<Connection>> openSharedMemory(int fd);

Result<std::unique_ptr<Listener>> listenTcp(const std::string& address, uint16_t port);
Result<std::unique_ptr<Connection>> connectTcp(const std::string& host, uint16_t port, Deadline deadline);

} // namespace mural
