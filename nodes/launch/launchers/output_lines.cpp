#include "nodes/launch/launchers/output_lines.hpp"

#include <array>
#include <cerrno>
#include <poll.h>
#include <string>
#include <sys/eventfd.h>
#include <unistd.h>
#include <utility>

namespace mural::launch {

OutputLines::OutputLines(FileDescriptor output, Take take, std::function<void()> beat, int64_t beatMs)
    : output_(std::move(output)),
      stop_(eventfd(0, EFD_CLOEXEC)),
      take_(std::move(take)),
      beat_(std::move(beat)),
      beatMs_(beatMs),
      thread_([this] { read(); }) {}

OutputLines::~OutputLines() {
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(stop_.get(), &one, sizeof one);
    thread_.join();
}

bool OutputLines::drain(Deadline deadline) const {
    while (!ended_) {
        if (deadline.passed()) return false;
        poll(nullptr, 0, 2);
    }
    return true;
}

void OutputLines::read() {
    std::string pending;
    std::array<char, 4096> piece;
    Deadline nextBeat = Deadline::inMs(beatMs_);
    while (true) {
        std::array<pollfd, 2> polled{{{output_.get(), POLLIN, 0}, {stop_.get(), POLLIN, 0}}};
        const int64_t waitMs = beat_ ? nextBeat.leftNs() / kNsPerMs + 1 : -1;
        if (poll(polled.data(), polled.size(), static_cast<int>(waitMs)) < 0 && errno != EINTR) break;
        if (beat_ && nextBeat.passed()) {
            beat_();
            nextBeat = Deadline::inMs(beatMs_);
        }
        if (polled[1].revents != 0) break;
        if (polled[0].revents == 0) continue;
        const ssize_t n = ::read(output_.get(), piece.data(), piece.size());
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (n <= 0) break;
        pending.append(piece.data(), static_cast<size_t>(n));
        size_t begin = 0;
        for (size_t end = 0; (end = pending.find('\n', begin)) != std::string::npos; begin = end + 1)
            take_(std::string_view(pending).substr(begin, end - begin));
        pending.erase(0, begin);
        if (pending.size() < kMaxLine) continue;
        take_(pending);
        pending.clear();
    }
    if (!pending.empty()) take_(pending);
    ended_ = true;
}

} // namespace mural::launch
