#include <cstdio>
#include <cstring>
#include <memory>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#if MURAL_BENCH_ZMQ
#include <zmq.h>
#endif

#include "common/base/clock.hpp"
#include "objects/ends/object_writer.hpp"
#include "tools/bench/objects/benches.hpp"
#include "tools/bench/objects/reader_processes.hpp"

namespace mural::bench {

namespace {

using namespace mural::objects;

struct Small {
    std::array<uint64_t, 8> words{};
    template <class Visit> void fields(Visit& visit) { visit(words); }
};
constexpr size_t kSmallBytes = sizeof(Small);

// One message of 64 bytes to all, acknowledged by all.
class FanOut {
public:
    virtual ~FanOut() = default;
    virtual bool send(uint64_t turn) = 0; // false: a reader has something else
};

bool checkSmall(ObjectReader& reader) {
    const auto state = reader.stateAt<Small>(1, "small", Deadline::inMs(0));
    return state && state.value()->words.front() == state.value()->words.back();
}

class ObjectFanOut : public FanOut {
public:
    ObjectFanOut(LineKind kind, size_t count)
        : count_(count), readers_(kind, count, readObjects(checkSmall)), writer_(readers_, {.keepsPushed = false}) {
        auto made = writer_.share(Small{}, {.name = "small"});
        if (made && made.value().commit() && readers_.awaitAcknowledgements() == count)
            state_ = std::make_unique<Shared<Small>>(std::move(made.value()));
    }
    bool send(uint64_t turn) override {
        if (!state_) return false;
        state_->edit().words.fill(turn);
        return state_->commit().ok() && readers_.awaitAcknowledgements() == count_;
    }

private:
    const size_t count_;
    ReaderProcesses readers_;
    ObjectWriter writer_;
    std::unique_ptr<Shared<Small>> state_;
};

// The same connections without objects.
class BlockFanOut : public FanOut {
public:
    BlockFanOut(LineKind kind, size_t count)
        : count_(count), readers_(kind, count, readBlocks(kSmallBytes, [](std::span<const std::byte> block) {
                                      return std::memcmp(block.data(), block.data() + block.size() - 8, 8) == 0;
                                  })) {}
    bool send(uint64_t turn) override {
        Small state;
        state.words.fill(turn);
        readers_.send(std::as_bytes(std::span(&state, 1)));
        return readers_.awaitAcknowledgements() == count_;
    }

private:
    const size_t count_;
    ReaderProcesses readers_;
};

bool readAll(int fd, void* into, size_t sizeBytes) {
    return ::recv(fd, into, sizeBytes, MSG_WAITALL) == static_cast<ssize_t>(sizeBytes);
}

// Plain sockets: the least that any library can do with TCP.
class TcpFanOut : public FanOut {
public:
    explicit TcpFanOut(size_t count) {
        const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        auto* const generic = reinterpret_cast<sockaddr*>(&address);
        if (::bind(listener, generic, length) != 0 || ::listen(listener, 16) != 0 ||
            ::getsockname(listener, generic, &length) != 0)
            return;
        for (size_t i = 0; i < count; ++i) {
            children_.start([&] {
                const int line = ::socket(AF_INET, SOCK_STREAM, 0);
                const int isOn = 1;
                ::setsockopt(line, IPPROTO_TCP, TCP_NODELAY, &isOn, sizeof isOn);
                if (::connect(line, generic, sizeof address) != 0) return;
                Small state;
                while (readAll(line, &state, kSmallBytes)) {
                    const char good = state.words.front() == state.words.back();
                    if (::send(line, &good, 1, MSG_NOSIGNAL) != 1) return;
                }
            });
            const int line = ::accept(listener, nullptr, nullptr);
            const int isOn = 1;
            ::setsockopt(line, IPPROTO_TCP, TCP_NODELAY, &isOn, sizeof isOn);
            lines_.push_back(line);
        }
        ::close(listener);
    }
    ~TcpFanOut() override {
        for (const int line : lines_) ::close(line);
    }
    bool send(uint64_t turn) override {
        Small state;
        state.words.fill(turn);
        bool isGood = !lines_.empty();
        for (const int line : lines_)
            isGood = isGood && ::send(line, &state, kSmallBytes, MSG_NOSIGNAL) == static_cast<ssize_t>(kSmallBytes);
        for (const int line : lines_) {
            char good = 0;
            isGood = readAll(line, &good, 1) && good == 1 && isGood;
        }
        return isGood;
    }

private:
    ChildProcesses children_;
    std::vector<int> lines_;
};

#if MURAL_BENCH_ZMQ
// PUB to all, PUSH back, over TCP.
class ZeroMqFanOut : public FanOut {
public:
    explicit ZeroMqFanOut(size_t count) : count_(count) {
        const std::string publish = "tcp://127.0.0.1:" + std::to_string(kFirstPort),
                          collect = "tcp://127.0.0.1:" + std::to_string(kFirstPort + 1);
        for (size_t i = 0; i < count; ++i) {
            children_.start([&] {
                void* const context = zmq_ctx_new();
                void* const in = zmq_socket(context, ZMQ_SUB);
                void* const out = zmq_socket(context, ZMQ_PUSH);
                zmq_setsockopt(in, ZMQ_SUBSCRIBE, "", 0);
                zmq_connect(in, publish.c_str());
                zmq_connect(out, collect.c_str());
                Small state;
                while (zmq_recv(in, &state, kSmallBytes, 0) == static_cast<int>(kSmallBytes)) {
                    const char good = state.words.front() == state.words.back();
                    zmq_send(out, &good, 1, 0);
                }
            });
        }
        context_ = zmq_ctx_new();
        out_ = zmq_socket(context_, ZMQ_PUB);
        in_ = zmq_socket(context_, ZMQ_PULL);
        const int noWait = 0, patienceMs = 20'000;
        zmq_setsockopt(out_, ZMQ_LINGER, &noWait, sizeof noWait);
        zmq_setsockopt(in_, ZMQ_RCVTIMEO, &patienceMs, sizeof patienceMs);
        if (zmq_bind(out_, publish.c_str()) != 0 || zmq_bind(in_, collect.c_str()) != 0) return;
        // Subscriptions arrive within this time.
        ::usleep(500'000);
        isReady_ = true;
    }
    ~ZeroMqFanOut() override {
        zmq_close(out_);
        zmq_close(in_);
        zmq_ctx_term(context_);
    }
    bool send(uint64_t turn) override {
        if (!isReady_) return false;
        Small state;
        state.words.fill(turn);
        zmq_send(out_, &state, kSmallBytes, 0);
        bool isGood = true;
        for (size_t i = 0; i < count_; ++i) {
            char good = 0;
            isGood = zmq_recv(in_, &good, 1, 0) == 1 && good == 1 && isGood;
        }
        return isGood;
    }

private:
    static constexpr int kFirstPort = 47'113;
    const size_t count_;
    ChildProcesses children_;
    void *context_ = nullptr, *out_ = nullptr, *in_ = nullptr;
    bool isReady_ = false;
};
#endif

struct Way {
    const char* name;
    std::unique_ptr<FanOut> fanOut;
    std::vector<double> microseconds;
};

int measure(size_t count, const ObjectBenchOptions& options) {
    constexpr int kRoundsPerTurn = 20;
    std::vector<Way> ways;
    ways.push_back({"plain TCP", std::make_unique<TcpFanOut>(count), {}});
    ways.push_back({"connections, shared memory", std::make_unique<BlockFanOut>(LineKind::SharedMemory, count), {}});
    ways.push_back({"connections, TCP", std::make_unique<BlockFanOut>(LineKind::Tcp, count), {}});
    ways.push_back({"objects, shared memory", std::make_unique<ObjectFanOut>(LineKind::SharedMemory, count), {}});
    ways.push_back({"objects, TCP", std::make_unique<ObjectFanOut>(LineKind::Tcp, count), {}});
#if MURAL_BENCH_ZMQ
    ways.push_back({"ZeroMQ", std::make_unique<ZeroMqFanOut>(count), {}}); // starts threads, so last
#endif
    uint64_t serial = 0;
    int wrong = 0;
    for (int turn = 0; turn < options.turns; ++turn)
        for (Way& way : ways)
            for (int round = 0; round < kRoundsPerTurn; ++round) {
                const int64_t begin = monotonicNowNs();
                wrong += !way.fanOut->send(++serial);
                if (wrong > 0) return wrong;
                way.microseconds.push_back(static_cast<double>(monotonicNowNs() - begin) / 1000);
            }
    const double plain = summaryOf(ways.front().microseconds).median;
    for (const Way& way : ways) {
        const Summary summary = summaryOf(way.microseconds);
        std::printf("%9zu  %-28s %9.0f (%.0f to %.0f) %8.2f\n", count, way.name, summary.median, summary.low,
                    summary.high, summary.median / plain);
    }
    return 0;
}

} // namespace

int benchFanOut(const ObjectBenchOptions& options) {
    std::printf("\n64 bytes known to all processes of this machine (us, medians with quartiles)\n");
    std::printf("%9s  %-28s %9s %20s\n", "processes", "way", "us", "/ plain TCP");
    int wrong = 0;
    for (const size_t count : {1, 4, 8}) wrong += measure(count, options);
    return wrong;
}

} // namespace mural::bench
