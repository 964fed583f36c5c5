// One byte stream between two processes, whatever carries it. Reliable, ordered, both directions.
//
// Descriptions as text:
//   pipe:                 two ends in one process
//   shm:                  shared memory between processes of one machine (ends passed by descriptor)
//   tcp://host:port       TCP
//   rsp://group:port?…    reliable multicast (transport/rsp/group_description.hpp)
//
// Threads: one thread may read while another writes; neither end is for two readers or two writers.
// Source: thesis, chapter "Collage", Connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/clock.hpp"
#include "common/result.hpp"

namespace mural {

struct NetworkPath {
    std::string ownAddress;   // numeric, of this end
    size_t datagramBytes = 0; // what a UDP datagram may hold to arrive in one packet, as far as both ends' cards know
};

class Connection {
public:
    Connection() = default;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    virtual ~Connection() = default;

    // Fills all of `into` or fails. Errors: the peer is gone, the deadline has passed.
    // A deadline that passes before the first byte leaves the stream usable (timedOut() is true then).
    virtual Result<void> read(std::span<std::byte> into, Deadline deadline) = 0;

    // Writes all of `bytes` or fails. After an error other than "nothing written" the stream is dead.
    virtual Result<void> write(std::span<const std::byte> bytes, Deadline deadline) = 0;

    // Makes what was written visible to the peer now (a wake-up, a push); write may delay it.
    virtual void flush() = 0;

    // Ends both directions; a reader or writer blocked on either side returns with an error soon.
    virtual void close() = 0;

    [[nodiscard]] virtual bool timedOut() const = 0;
    [[nodiscard]] virtual bool alive() const = 0;
    [[nodiscard]] virtual std::string describe() const = 0;

    // What it knows of the network in between; nothing: there is none.
    [[nodiscard]] virtual NetworkPath path() const { return {}; }

    // Bytes since the start, for the report.
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
    // The description under which others connect, with the port that was really taken.
    [[nodiscard]] virtual std::string describe() const = 0;
};

// Both ends in this process.
struct PipePair {
    std::unique_ptr<Connection> a;
    std::unique_ptr<Connection> b;
};
Result<PipePair> makePipe(size_t capacityBytes = size_t{1} << 20);

// A shared-memory connection: this end, and the descriptor to give to the other process (inherit it
// by fork/exec and call openSharedMemory there). Capacity is per direction, a power of two.
struct SharedMemoryOffer {
    std::unique_ptr<Connection> connection;
    int peerFd = -1; // owned by the caller; close it after the child has been started
};
Result<SharedMemoryOffer> offerSharedMemory(size_t capacityBytes);
Result<std::unique_ptr<Connection>> openSharedMemory(int fd);

Result<std::unique_ptr<Listener>> listenTcp(const std::string& address, uint16_t port);
Result<std::unique_ptr<Connection>> connectTcp(const std::string& host, uint16_t port, Deadline deadline);

} // namespace mural
