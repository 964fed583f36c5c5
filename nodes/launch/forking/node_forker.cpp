#include "nodes/launch/forking/node_forker.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <poll.h>
#include <span>
#include <sys/socket.h>
#include <utility>

#include "common/ipc/descriptor_message.hpp"
#include "nodes/launch/child_process.hpp"

namespace mural {
namespace {

constexpr int64_t kForkReplyMs = 10'000; // loading the driver takes a tenth of a second from a warm page cache
constexpr int kReplySliceMs = 100;
constexpr int64_t kKilledMs = 5'000;

class ForkedNode : public RunningNode {
public:
    ForkedNode(std::shared_ptr<NodeForker> forker, const ForkReply& forked)
        : forker_(std::move(forker)), number_(forked.node), pid_(forked.value) {}
    ~ForkedNode() override { ForkedNode::kill(); }

    [[nodiscard]] pid_t pid() const override { return pid_; }
    std::optional<std::string> ended() override { return forker_->endOf(number_); }
    void kill() override {
        if (ended()) return; // another process may reuse its pid
        ::kill(-pid_, SIGKILL);
        ::kill(pid_, SIGKILL);
        waitEnded(Deadline::inMs(kKilledMs));
    }
    [[nodiscard]] std::string details() const override { return "; see its messages"; }

private:
    const std::shared_ptr<NodeForker> forker_;
    const uint32_t number_;
    const pid_t pid_;
};

} // namespace

Result<std::shared_ptr<NodeForker>> NodeForker::start(const std::string& executable) {
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return Error{std::string("socketpair: ") + std::strerror(errno)};
    FileDescriptor ours(ends[0]);
    const FileDescriptor theirs(ends[1]);
    NodeCommand command;
    command.arguments = {executable, "fork-nodes", "--control-fd", std::to_string(theirs.get())};
    command.inheritFd = theirs.get();
    auto process = NodeProcess::start(command);
    if (!process) return process.error();
    return std::shared_ptr<NodeForker>(new NodeForker(std::move(*process), std::move(ours)));
}

NodeForker::NodeForker(std::unique_ptr<NodeProcess> process, FileDescriptor control)
    : process_(std::move(process)), control_(std::move(control)) {}

std::optional<ForkReply> NodeForker::takeReplies() {
    std::optional<ForkReply> answer;
    while (!hasEnded_) {
        ForkReply reply;
        FileDescriptor none;
        const ssize_t got = receiveWithDescriptor(control_.get(), std::as_writable_bytes(std::span(&reply, 1)), none);
        if (got < 0 && errno == EAGAIN) break;
        if (got != sizeof reply) {
            hasEnded_ = true;
        } else if (reply.kind == ForkReply::Kind::Ended) {
            statuses_[reply.node] = reply.value;
        } else {
            answer = reply;
        }
    }
    return answer;
}

Result<std::unique_ptr<RunningNode>> NodeForker::fork(int connectFd) {
    const std::lock_guard lock(mutex_);
    (void)takeReplies();
    const std::byte request{};
    if (hasEnded_ || sendWithDescriptor(control_.get(), std::span(&request, 1), connectFd) != 1)
        return Error{"the process that forks nodes has ended"};
    const Deadline deadline = Deadline::inMs(kForkReplyMs);
    while (!hasEnded_ && !deadline.passed()) {
        const auto reply = takeReplies();
        if (!reply) {
            pollfd polled{control_.get(), POLLIN, 0};
            (void)poll(&polled, 1, kReplySliceMs);
            continue;
        }
        if (reply->kind == ForkReply::Kind::Failed) return Error{std::string("fork: ") + std::strerror(reply->value)};
        return std::unique_ptr<RunningNode>(std::make_unique<ForkedNode>(shared_from_this(), *reply));
    }
    // The next request would take a late reply for its own.
    hasEnded_ = true;
    process_->kill();
    return Error{"the process that forks nodes does not reply"};
}

std::optional<std::string> NodeForker::endOf(uint32_t node) {
    const std::lock_guard lock(mutex_);
    (void)takeReplies();
    if (const auto found = statuses_.find(node); found != statuses_.end()) return launch::describeEnd(found->second);
    if (hasEnded_) return "signal 9 (Killed), with the process that forked it";
    return std::nullopt;
}

} // namespace mural
