#include "tools/bench/objects/reader_processes.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "objects/ends/reader_core.hpp"

namespace mural::bench {

namespace {

constexpr int64_t kPatienceMs = 60'000;
constexpr size_t kLineBytes = size_t{1} << 20;

[[noreturn]] void fail(const char* what, const std::string& problem) {
    std::fprintf(stderr, "objects_bench: %s: %s\n", what, problem.c_str());
    std::exit(1);
}

bool acknowledge(Connection& line, bool isGood) {
    const std::byte good = isGood ? std::byte{1} : std::byte{0};
    const bool isWritten = line.write(std::span(&good, 1), Deadline::inMs(kPatienceMs)).ok();
    line.flush();
    return isWritten;
}

class NoSink : public objects::MessageSink {
public:
    void toAll(std::span<const std::byte>) override {}
    void toOne(objects::PeerId, std::span<const std::byte>) override {}
};

} // namespace

ReaderProcesses::Serve readObjects(std::function<bool(ObjectReader&)> check) {
    return [check = std::move(check)](Connection& line) {
        NoSink sink;
        objects::ReaderEnd end(sink);
        std::vector<std::byte> message;
        for (;;) {
            uint32_t sizeBytes = 0;
            if (!line.read(std::as_writable_bytes(std::span(&sizeBytes, 1)), Deadline::inMs(kPatienceMs))) return;
            message.resize(sizeBytes);
            if (!line.read(message, Deadline::inMs(kPatienceMs))) return;
            const auto result = end.input(message, 0);
            if (static_cast<objects::MessageKind>(message.front()) != objects::MessageKind::Commit) continue;
            if (!acknowledge(line, result && check(end.reader()))) return;
        }
    };
}

ReaderProcesses::Serve readBlocks(size_t sizeBytes, std::function<bool(std::span<const std::byte>)> check) {
    return [sizeBytes, check = std::move(check)](Connection& line) {
        std::vector<std::byte> block(sizeBytes);
        while (line.read(block, Deadline::inMs(kPatienceMs)))
            if (!acknowledge(line, check(block))) return;
    };
}

ChildProcesses::~ChildProcesses() {
    for (const pid_t child : children_) ::kill(child, SIGKILL);
    for (const pid_t child : children_) ::waitpid(child, nullptr, 0);
}

void ChildProcesses::start(const std::function<void()>& work) {
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) fail("fork", std::strerror(errno));
    if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        work();
        ::_exit(0);
    }
    children_.push_back(child);
}

ReaderProcesses::ReaderProcesses(LineKind kind, size_t count, const Serve& serve) {
    for (size_t i = 0; i < count; ++i) {
        if (kind == LineKind::SharedMemory) {
            auto offer = offerSharedMemory(kLineBytes);
            if (!offer) fail("shared memory", offer.error().message);
            const int fd = offer.value().peerFd;
            children_.start([&] {
                auto line = openSharedMemory(fd);
                if (line) serve(*line.value());
            });
            ::close(fd);
            lines_.push_back(std::move(offer.value().connection));
            continue;
        }
        auto listener = listenTcp("127.0.0.1", 0);
        if (!listener) fail("listen", listener.error().message);
        const std::string where = listener.value()->describe(); // tcp://127.0.0.1:PORT
        const auto port = static_cast<uint16_t>(std::atoi(where.substr(where.rfind(':') + 1).c_str()));
        children_.start([&] {
            auto line = connectTcp("127.0.0.1", port, Deadline::inMs(kPatienceMs));
            if (line) serve(*line.value());
        });
        auto line = listener.value()->accept(Deadline::inMs(kPatienceMs));
        if (!line) fail("accept", line.error().message);
        lines_.push_back(std::move(line.value()));
    }
}

ReaderProcesses::~ReaderProcesses() {
    for (const auto& line : lines_) line->close();
}

void ReaderProcesses::toAll(std::span<const std::byte> message) {
    const auto sizeBytes = static_cast<uint32_t>(message.size());
    framed_.resize(sizeof sizeBytes + message.size());
    std::memcpy(framed_.data(), &sizeBytes, sizeof sizeBytes);
    std::memcpy(framed_.data() + sizeof sizeBytes, message.data(), message.size());
    send(framed_);
}

void ReaderProcesses::send(std::span<const std::byte> bytes) {
    for (const auto& line : lines_) {
        const auto written = line->write(bytes, Deadline::inMs(kPatienceMs));
        if (!written) fail("write", written.error().message);
        line->flush();
    }
}

size_t ReaderProcesses::awaitAcknowledgements() {
    size_t good = 0;
    for (const auto& line : lines_) {
        std::byte byte{};
        const auto result = line->read(std::span(&byte, 1), Deadline::inMs(kPatienceMs));
        if (!result) fail("read", result.error().message);
        good += byte == std::byte{1};
    }
    return good;
}

} // namespace mural::bench
