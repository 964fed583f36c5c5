#include "tools/mural/network/line_channel.hpp"

#include <algorithm>
#include <climits>

#include "transport/tcp/socket_wait.hpp"
#include "transport/system_error.hpp"

namespace mural::cli {

Result<std::string> LineChannel::read(Deadline deadline) {
    while (true) {
        if (const size_t end = waiting_.find('\n'); end != std::string::npos) {
            std::string line = waiting_.substr(0, end);
            waiting_.erase(0, end + 1);
            return line;
        }
        if (waiting_.size() > kMaxLineBytes) return Error{"what it says has no end of line"};
        if (waitForSocket(in_.get(), POLLIN, deadline) == 0) return Error{"it says nothing"};
        char piece[4096];
        const ssize_t n = ::read(in_.get(), piece, sizeof piece);
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (n < 0) return Error{"it can't be heard: " + errnoText(errno)};
        if (n == 0) return Error{"it has ended"};
        waiting_.append(piece, static_cast<size_t>(n));
    }
}

Result<void> LineChannel::write(const std::string& line, Deadline deadline) {
    const std::string bytes = line + "\n";
    for (size_t at = 0; at < bytes.size();) {
        if (waitForSocket(out_.get(), POLLOUT, deadline) == 0) return Error{"it does not listen"};
        // a size that never blocks
        const ssize_t n = ::write(out_.get(), bytes.data() + at, std::min<size_t>(bytes.size() - at, PIPE_BUF));
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (n < 0) return Error{errno == EPIPE ? "it has ended" : "nothing can be said to it: " + errnoText(errno)};
        at += static_cast<size_t>(n);
    }
    return {};
}

} // namespace mural::cli
