// Connected pairs of each kind, and a stream of bytes that encode their position.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <sys/types.h>

#include "transport/connection.hpp"

namespace mural::test {

enum class LinkKind { Pipe, SharedMemory, Tcp, Secure, Fabric, Rsp };
inline constexpr std::array kAllLinkKinds = {LinkKind::Pipe,   LinkKind::SharedMemory, LinkKind::Tcp,
                                             LinkKind::Secure, LinkKind::Fabric,       LinkKind::Rsp};
std::string linkName(LinkKind kind);
// Why this build or machine lacks such links; empty: available. Only plug-ins may be missing.
std::string whyNoLinks(LinkKind kind);

// Both ends in this process; capacity applies to rings only. Null pointers after a failure, with the reason on stderr.
struct LinkedPair {
    std::unique_ptr<Connection> a;
    std::unique_ptr<Connection> b;
};
LinkedPair makeLinkedPair(LinkKind kind, size_t capacityBytes);

// A deterministic byte sequence: fills `into` with its continuation.
class ByteStream {
public:
    explicit ByteStream(uint64_t seed) : state_(seed) {}
    void fill(std::span<std::byte> into);

private:
    uint8_t nextByte();
    uint64_t state_;
    uint64_t word_ = 0;
    int bytesLeft_ = 0;
};

// Order-sensitive, independent of the division into pieces.
class Checksum {
public:
    void add(std::span<const std::byte> bytes);
    [[nodiscard]] uint64_t value() const;

private:
    void addWord(uint64_t word) { sum_ = (sum_ ^ word) * 0x9e3779b97f4a7c15ULL; }
    uint64_t sum_ = 0;
    std::array<std::byte, 8> rest_{};
    size_t restBytes_ = 0;
};

// MURAL_TEST_SEED, or a new seed each time. Printed, so that a failure can be repeated.
uint64_t testSeed();

// Sizes distributed evenly over the orders of magnitude from 1 to most.
size_t randomSize(std::mt19937_64& random, size_t maximum);

// Returns true if the thread sleeps in the kernel before the deadline, for tests with a blocked peer.
bool waitUntilAsleep(pid_t thread, Deadline deadline);
pid_t currentThread();

} // namespace mural::test
