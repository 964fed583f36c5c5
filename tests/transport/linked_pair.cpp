#include "tests/transport/linked_pair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sched.h>
#include <thread>
#include <sys/syscall.h>
#include <unistd.h>

#include "transport/connect.hpp"
#include "transport/plugin/plugin_library.hpp"
#include "transport/rsp/group_connection.hpp"
#include "transport/secure/secure_connection.hpp"

namespace mural::test {

namespace {

template <class T> bool worked(const Result<T>& result) {
    if (!result) std::fprintf(stderr, "%s\n", result.error().message.c_str());
    return result.ok();
}

LinkedPair makeTcpPair() {
    auto listener = listenTcp("127.0.0.1", 0);
    if (!worked(listener)) return {};
    auto a = connectTo((*listener)->describe(), Deadline::inMs(5000));
    if (!worked(a)) return {};
    auto b = (*listener)->accept(Deadline::inMs(5000));
    if (!worked(b)) return {};
    return {std::move(*a), std::move(*b)};
}

LinkedPair makeSecurePair() {
    LinkedPair plain = makeTcpPair();
    if (!plain.a) return {};
    const ChannelSecret secret{std::byte{7}};
    std::unique_ptr<Connection> b;
    std::thread accepting([&] {
        auto made = SecureConnection::accepting(
            std::move(plain.b), [&](const std::string&) { return std::optional(secret); }, Deadline::inMs(5000));
        if (worked(made)) b = std::move(*made);
    });
    auto a = SecureConnection::connecting(std::move(plain.a), "a", secret, Deadline::inMs(5000));
    accepting.join();
    if (!worked(a) || !b) return {};
    return {std::move(*a), std::move(b)};
}

LinkedPair makeFabricPair() {
    auto listener = listenAt("fabric://127.0.0.1:0");
    if (!worked(listener)) return {};
    std::unique_ptr<Connection> b;
    std::thread accepting([&] {
        auto made = (*listener)->accept(Deadline::inMs(5000));
        if (worked(made)) b = std::move(*made);
    });
    auto a = connectTo((*listener)->describe(), Deadline::inMs(5000));
    accepting.join();
    if (!worked(a) || !b) return {};
    return {std::move(*a), std::move(b)};
}

LinkedPair makeRspPair() {
    rsp::GroupOptions options;
    options.group = "239.255.77.87:" + std::to_string(20'000 + getpid() % 20'000); // tests run concurrently
    options.interface = "lo";
    options.control = "127.0.0.1:0";
    options.silentMs = options.stalledMs = 30'000; // for busy machines
    options.probeMs = 10'000;
    options.stalled = rsp::StallPolicy::Wait;
    options.windowDatagrams = 256;
    auto listener = rsp::hostGroup(options);
    if (!worked(listener)) return {};
    options.control = (*listener)->describe().substr((*listener)->describe().rfind('=') + 1);
    auto a = rsp::joinGroup(options, Deadline::inMs(10'000));
    if (!worked(a)) return {};
    auto b = (*listener)->accept(Deadline::inMs(10'000));
    if (!worked(b)) return {};
    return {std::move(*a), std::move(*b)};
}

} // namespace

std::string linkName(LinkKind kind) {
    switch (kind) {
    case LinkKind::Pipe: return "Pipe";
    case LinkKind::SharedMemory: return "SharedMemory";
    case LinkKind::Tcp: return "Tcp";
    case LinkKind::Secure: return "Secure";
    case LinkKind::Fabric: return "Fabric";
    case LinkKind::Rsp: break;
    }
    return "Rsp";
}

// A build with libfabric includes the plug-in, so a missing plug-in is a failure. libfabric itself may be missing at
// run time.
std::string whyNoLinks(LinkKind kind) {
    if (kind != LinkKind::Fabric) return {};
#ifdef MURAL_HAS_FABRIC
    const auto plugin = openPlugin("fabric");
    const bool libraryGone = !plugin && plugin.error().message.find("libfabric.so") != std::string::npos;
    return libraryGone ? plugin.error().message : std::string();
#else
    return "this build has no libfabric (Debian's libfabric-dev)";
#endif
}

LinkedPair makeLinkedPair(LinkKind kind, size_t capacityBytes) {
    if (kind == LinkKind::Tcp) return makeTcpPair();
    if (kind == LinkKind::Secure) return makeSecurePair();
    if (kind == LinkKind::Fabric) return makeFabricPair();
    if (kind == LinkKind::Rsp) return makeRspPair();
    if (kind == LinkKind::Pipe) {
        auto pair = makePipe(capacityBytes);
        if (!worked(pair)) return {};
        return {std::move(pair->a), std::move(pair->b)};
    }
    auto offer = offerSharedMemory(capacityBytes);
    if (!worked(offer)) return {};
    auto b = openSharedMemory(offer->peerFd);
    if (!worked(b)) return {};
    return {std::move(offer->connection), std::move(*b)};
}

uint8_t ByteStream::nextByte() {
    if (bytesLeft_ == 0) {
        state_ += 0x9e3779b97f4a7c15ULL; // splitmix64
        uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        word_ = z ^ (z >> 31);
        bytesLeft_ = 8;
    }
    const auto byte = static_cast<uint8_t>(word_);
    word_ >>= 8;
    --bytesLeft_;
    return byte;
}

void ByteStream::fill(std::span<std::byte> into) {
    for (std::byte& each : into) each = std::byte{nextByte()};
}

void Checksum::add(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        if (restBytes_ == 0 && bytes.size() >= 8) {
            uint64_t word = 0;
            std::memcpy(&word, bytes.data(), 8);
            addWord(word);
            bytes = bytes.subspan(8);
            continue;
        }
        rest_[restBytes_++] = bytes.front();
        bytes = bytes.subspan(1);
        if (restBytes_ < 8) continue;
        addWord(std::bit_cast<uint64_t>(rest_));
        restBytes_ = 0;
    }
}

uint64_t Checksum::value() const {
    Checksum end = *this;
    std::memset(end.rest_.data() + restBytes_, 0, 8 - restBytes_);
    end.addWord(std::bit_cast<uint64_t>(end.rest_));
    end.addWord(restBytes_);
    return end.sum_;
}

uint64_t testSeed() {
    const char* given = std::getenv("MURAL_TEST_SEED");
    const uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device()();
    std::printf("MURAL_TEST_SEED=%llu\n", static_cast<unsigned long long>(seed));
    return seed;
}

size_t randomSize(std::mt19937_64& random, size_t maximum) {
    std::uniform_real_distribution<double> exponent(0.0, std::log(static_cast<double>(maximum) + 1));
    return std::clamp<size_t>(static_cast<size_t>(std::exp(exponent(random))), 1, maximum);
}

bool waitUntilAsleep(pid_t thread, Deadline deadline) {
    const std::string path = "/proc/self/task/" + std::to_string(thread) + "/stat";
    while (!deadline.passed()) {
        std::string line;
        std::getline(std::ifstream(path) >> std::ws, line);
        const size_t name = line.rfind(") ");
        if (name != std::string::npos && line.size() > name + 2 && line[name + 2] == 'S') return true;
        sched_yield();
    }
    return false;
}

pid_t currentThread() { return static_cast<pid_t>(syscall(SYS_gettid)); }

} // namespace mural::test
