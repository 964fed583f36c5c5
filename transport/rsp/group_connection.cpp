#include "transport/rsp/group_connection.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "transport/connection_error.hpp"

namespace mural::rsp {

namespace {

constexpr int64_t kDrainMs = 1000;
constexpr int64_t kPollAgainNs = 100 * kNsPerMs; // interval of checks whether this end was closed

Deadline inSlice(Deadline deadline) { return Deadline::inMs(deadline.leftNs(kPollAgainNs) / kNsPerMs + 1); }

// `whole`: this is the member's own end, and owns its group; otherwise one connection of the host.
class GroupConnection final : public Connection {
public:
    GroupConnection(std::shared_ptr<Group> group, MemberId from, bool whole, std::string description,
                    std::vector<std::byte> first = {})
        : group_(std::move(group)),
          from_(from),
          whole_(whole),
          description_(std::move(description)),
          first_(std::move(first)) {}
    ~GroupConnection() override { GroupConnection::close(); }

    Result<void> read(std::span<std::byte> into, Deadline deadline) override {
        readTimedOut_ = false;
        size_t done = takeFirst(into);
        const auto failed = [&](const std::string& why) {
            return connectionError(description_, "read", done, into.size(), why);
        };
        while (done < into.size()) {
            if (closed_) return failed(ending::kClosedHere);
            const Deadline slice = inSlice(deadline);
            auto got = group_->read(from_, into.subspan(done), slice);
            if (got && *got > 0) {
                done += *got;
                bytesRead_ += *got;
                continue;
            }
            if (closed_) return failed(ending::kClosedHere);
            if (got || !slice.passed()) {
                gone_ = true;
                return failed(got ? ending::kPeerGone : got.error().message);
            }
            if (!deadline.passed()) continue;
            readTimedOut_ = done == 0;
            if (done > 0) endStream();
            return failed(done > 0 ? ending::kCutInHalf : ending::kIdle);
        }
        return {};
    }

    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override {
        writeTimedOut_ = false;
        size_t done = 0;
        const auto failed = [&](const std::string& why) {
            return connectionError(description_, "write", done, bytes.size(), why);
        };
        while (done < bytes.size()) {
            if (closed_) return failed(ending::kClosedHere);
            if (!alive()) return failed(ending::kPeerGone);
            const Deadline slice = inSlice(deadline);
            auto took = group_->writeSome(bytes.subspan(done), slice);
            if (took) {
                done += *took;
                continue;
            }
            if (closed_) return failed(ending::kClosedHere);
            if (!slice.passed()) return failed(took.error().message);
            if (!deadline.passed()) continue;
            writeTimedOut_ = done == 0;
            if (done > 0) endStream();
            return failed(done > 0 ? ending::kCutInHalf : ending::kIdle);
        }
        bytesWritten_ += bytes.size();
        return {};
    }
    void flush() override {
        if (!closed_) group_->flush();
    }
    void close() override {
        if (closed_) return;
        group_->flush();
        static_cast<void>(group_->waitArrived(Deadline::inMs(kDrainMs)).ok()); // best effort
        endStream();
    }

    [[nodiscard]] bool timedOut() const override { return (readTimedOut_ || writeTimedOut_) && !closed_; }
    [[nodiscard]] bool alive() const override { return !closed_ && !gone_ && group_->isMember(from_); }
    [[nodiscard]] std::string describe() const override { return description_; }
    [[nodiscard]] uint64_t bytesWritten() const override { return bytesWritten_; }
    [[nodiscard]] uint64_t bytesRead() const override { return bytesRead_; }

private:
    size_t takeFirst(std::span<std::byte> into) {
        if (first_.empty()) return 0;
        const size_t count = std::min(into.size(), first_.size() - firstRead_);
        std::copy_n(first_.begin() + static_cast<std::ptrdiff_t>(firstRead_), count, into.begin());
        firstRead_ += count;
        bytesRead_ += count;
        if (firstRead_ == first_.size()) first_ = {};
        return count;
    }

    void endStream() {
        if (closed_.exchange(true)) return;
        if (whole_)
            group_->leave();
        else
            group_->remove(from_, "the host has closed its connection");
    }

    const std::shared_ptr<Group> group_;
    const MemberId from_;
    const bool whole_;
    const std::string description_;
    std::vector<std::byte> first_; // owned by the reader
    size_t firstRead_ = 0;
    std::atomic<bool> closed_{false};
    std::atomic<bool> gone_{false};
    std::atomic<bool> readTimedOut_{false};
    std::atomic<bool> writeTimedOut_{false};
    std::atomic<uint64_t> bytesWritten_{0};
    std::atomic<uint64_t> bytesRead_{0};
};

std::string textOf(const GroupOptions& options, const std::string& control) {
    return "rsp://" + options.group + "?control=" + control;
}

class GroupListener final : public Listener {
public:
    GroupListener(std::shared_ptr<Group> group, std::string description)
        : group_(std::move(group)), description_(std::move(description)) {}

    Result<std::unique_ptr<Connection>> accept(Deadline deadline) override {
        auto member = group_->accept(deadline);
        if (!member) return Error{description_ + ": " + member.error().message};
        return std::unique_ptr<Connection>(std::make_unique<GroupConnection>(
            group_, *member, false, description_ + ", member " + std::to_string(*member)));
    }
    [[nodiscard]] std::string describe() const override { return description_; }

private:
    const std::shared_ptr<Group> group_;
    const std::string description_;
};

} // namespace

Result<std::unique_ptr<Connection>> joinGroup(const GroupOptions& options, Deadline deadline) {
    auto group = Group::join(options, deadline);
    if (!group) return group.error();
    return streamOfHost(std::move(*group), options, {});
}

std::unique_ptr<Connection> streamOfHost(std::unique_ptr<Group> group, const GroupOptions& options,
                                         std::vector<std::byte> first) {
    return std::make_unique<GroupConnection>(std::move(group), kHost, true, textOf(options, options.control),
                                             std::move(first));
}

Result<std::unique_ptr<Listener>> hostGroup(const GroupOptions& options) {
    auto group = Group::host(options);
    if (!group) return group.error();
    const std::string description = textOf(options, (*group)->controlAddress());
    return std::unique_ptr<Listener>(std::make_unique<GroupListener>(std::move(*group), description));
}

} // namespace mural::rsp
