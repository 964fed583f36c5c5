#include "nodes/launch/forking/fork_server.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <poll.h>
#include <span>
#include <string>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "common/ipc/descriptor_message.hpp"
#include "common/ipc/file_descriptor.hpp"
#include "common/log/log.hpp"
#include "nodes/launch/forking/fork_protocol.hpp"
#include "nodes/launch/forking/preload_driver.hpp"

namespace mural {
namespace {

struct ForkedChild {
    uint32_t node; // number of its request
    pid_t pid;
    FileDescriptor end; // pidfd: readable after the end of the process
};

// A fork copies only the calling thread: locks of others would stay locked in the node.
bool hasOneThread() {
    DIR* folder = opendir("/proc/self/task");
    if (folder == nullptr) return false;
    int threads = 0;
    while (const dirent* entry = readdir(folder)) threads += entry->d_name[0] != '.';
    closedir(folder);
    return threads == 1;
}

// Shows a node in `ps` as `mural node --connect-fd N`. The kernel shows the memory of the arguments, which begins with
// the first argument and is contiguous.
void showAsNode(int connectFd) {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    const std::string shown((std::istreambuf_iterator<char>(file)), {});
    const std::string wanted =
        std::string(program_invocation_name) + '\0' + "node" + '\0' + "--connect-fd" + '\0' + std::to_string(connectFd);
    if (wanted.size() >= shown.size()) return;
    std::memset(program_invocation_name, 0, shown.size());
    std::memcpy(program_invocation_name, wanted.data(), wanted.size());
}

class ForkServer {
public:
    explicit ForkServer(int controlFd) : control_(controlFd) {}

    // Returns nothing in this process after the head has closed the connection. Returns the descriptor of its shared
    // memory in a forked node.
    std::optional<int> serve() {
        while (true) {
            std::vector<pollfd> polled{{control_.get(), POLLIN, 0}};
            for (const ForkedChild& child : children_) polled.push_back({child.end.get(), POLLIN, 0});
            if (poll(polled.data(), polled.size(), -1) < 0) {
                if (errno == EINTR) continue;
                return std::nullopt;
            }
            reportEnds();
            if (polled.front().revents == 0) continue;
            std::byte request{};
            FileDescriptor memory;
            const ssize_t got = receiveWithDescriptor(control_.get(), std::span(&request, 1), memory);
            if (got < 0 && errno == EAGAIN) continue;
            if (got <= 0) return std::nullopt;
            if (const auto connectFd = forkNode(std::move(memory))) return connectFd;
        }
    }

private:
    void reply(const ForkReply& message) {
        // The head reads all replies, and there are few: the socket's buffer has room.
        (void)sendWithDescriptor(control_.get(), std::as_bytes(std::span(&message, 1)), -1);
    }

    void reportEnds() {
        for (auto child = children_.begin(); child != children_.end();) {
            int status = 0;
            if (waitpid(child->pid, &status, WNOHANG) != child->pid) {
                ++child;
                continue;
            }
            reply({ForkReply::Kind::Ended, child->node, status});
            child = children_.erase(child);
        }
    }

    std::optional<int> forkNode(FileDescriptor memory) {
        const uint32_t node = requests_++;
        if (!memory.valid() || !hasOneThread()) {
            reply({ForkReply::Kind::Failed, node, memory.valid() ? EDEADLK : EBADF});
            return std::nullopt;
        }
        const pid_t server = getpid();
        const pid_t pid = fork();
        if (pid == 0) return becomeNode(std::move(memory), server);
        if (pid < 0) {
            reply({ForkReply::Kind::Failed, node, errno});
            return std::nullopt;
        }
        children_.push_back({node, pid, FileDescriptor(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)))});
        reply({ForkReply::Kind::Forked, node, pid});
        return std::nullopt;
    }

    // Makes the process as NodeProcess starts it: a session of its own, which ends with the process that started it.
    int becomeNode(FileDescriptor memory, pid_t server) {
        setsid();
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != server) _exit(127); // the server died before PR_SET_PDEATHSIG took effect
        control_ = FileDescriptor();
        children_.clear();
        showAsNode(memory.get());
        return memory.release();
    }

    FileDescriptor control_;
    uint32_t requests_ = 0;
    std::vector<ForkedChild> children_;
};

} // namespace

int runForkServer(int controlFd, const std::function<int(int connectFd)>& runNode) {
    if (fcntl(controlFd, F_SETFD, FD_CLOEXEC) != 0) {
        log::error(log::Topic::Launch, "descriptor ", controlFd, ": ", std::strerror(errno),
                   "; mural run starts this command and passes its connection");
        return 1;
    }
    preloadDriver();
    const auto connectFd = ForkServer(controlFd).serve();
    return connectFd ? runNode(*connectFd) : 0;
}

} // namespace mural
