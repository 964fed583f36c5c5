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
        if (waiting_.size() > kMaxLineBytes) return Error{"the peer sent an overlong line"};
        if (waitForSocket(in_.get(), POLLIN, deadline) == 0) return Error{"no reply from the peer in time"};
        char piece[4096];
        const ssize_t n = ::read(in_.get(), piece, sizeof piece);
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (n < 0) return Error{"cannot read from the peer: " + errnoText(errno)};
        if (n == 0) return Error{"the peer ended"};
        waiting_.append(piece, static_cast<size_t>(n));
    }
}

Result<void> LineChannel::write(const std::string& line, Deadline deadline) {
    const std::string bytes = line + "\n";
    for (size_t at = 0; at < bytes.size();) {
        if (waitForSocket(out_.get(), POLLOUT, deadline) == 0) return Error{"the peer does not read"};
        // a size that never blocks
        const ssize_t n = ::write(out_.get(), bytes.data() + at, std::min<size_t>(bytes.size() - at, PIPE_BUF));
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (n < 0) return Error{errno == EPIPE ? "the peer ended" : "cannot write to the peer: " + errnoText(errno)};
        at += static_cast<size_t>(n);
    }
    return {};
}

} // namespace mural::cli
