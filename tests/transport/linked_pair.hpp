// Two connected ends of each kind, and a stream of bytes whose every place is known.
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
// Why this build or machine has no such links; empty: it has. Only plug-ins may be missing.
std::string whyNoLinks(LinkKind kind);

// Both ends in this process; capacity counts for the rings only. Empty pointers when it failed (the
// reason is on stderr).
struct LinkedPair {
    std::unique_ptr<Connection> a;
    std::unique_ptr<Connection> b;
};
LinkedPair makeLinkedPair(LinkKind kind, size_t capacityBytes);

// Deterministic bytes in one pass: fills `into` with what follows in the stream.
class ByteStream {
public:
    explicit ByteStream(uint64_t seed)
        : state_(seed) {}
    void fill(std::span<std::byte> into);

private:
    uint8_t nextByte();
    uint64_t state_;
    uint64_t word_ = 0;
    int bytesLeft_ = 0;
};

// Order-sensitive, independent of how the bytes are cut.
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

// MURAL_TEST_SEED or a new one each time; printed, so that a failure can be repeated.
uint64_t testSeed();

// Sizes spread evenly over the orders of magnitude from 1 to most.
size_t randomSize(std::mt19937_64& random, size_t most);

// True when the thread sleeps in the kernel before the deadline: for tests that need a blocked
// peer.
bool waitUntilAsleep(pid_t thread, Deadline deadline);
pid_t currentThread();

} // namespace mural::test
