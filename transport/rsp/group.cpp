#include "transport/rsp/group.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "transport/rsp/io/group_state.hpp"

namespace mural::rsp {

namespace {
constexpr size_t kMaxPieces = 32; // datagrams copied per lock
Error tooLate(const std::string& what) { return Error{"the deadline passed while waiting for " + what}; }
} // namespace

Group::Group(std::shared_ptr<State> state) : state_(std::move(state)) {}

Group::~Group() { state_->stop(); }

Result<std::unique_ptr<Group>> Group::host(const GroupOptions& options) {
    auto state = std::make_shared<State>(options);
    if (auto r = state->openHost(); !r) return r.error();
    return std::unique_ptr<Group>(new Group(std::move(state)));
}

Result<std::unique_ptr<Group>> Group::join(const GroupOptions& options, Deadline deadline) {
    auto state = std::make_shared<State>(options);
    std::unique_ptr<Group> group(new Group(state));
    if (auto r = state->openMember(deadline); !r) return r.error();
    std::unique_lock lock(state->mutex);
    while (!state->core->live() || !state->core->receiver(kHost)) {
        if (!state->failure.empty()) return Error{state->failure};
        if (deadline.passed())
            return tooLate("the host to accept this member; check that " + options.control + " replies");
        state->changed.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kSliceNs)));
    }
    return group;
}

std::string Group::controlAddress() const { return state_->controlAddress; }

MemberId Group::self() const {
    const std::lock_guard lock(state_->mutex);
    return state_->core->self();
}

std::vector<MemberId> Group::members() const {
    const std::lock_guard lock(state_->mutex);
    std::vector<MemberId> ids;
    for (const auto& [id, info] : state_->core->members()) ids.push_back(id);
    return ids;
}

bool Group::isMember(MemberId id) const {
    const std::lock_guard lock(state_->mutex);
    return state_->failure.empty() && state_->core->members().contains(id);
}

Result<void> Group::waitForMembers(size_t count, Deadline deadline) {
    std::unique_lock lock(state_->mutex);
    while (state_->core->members().size() < count) {
        if (!state_->failure.empty()) return Error{state_->failure};
        if (deadline.passed())
            return tooLate(std::to_string(count) + " members; " + std::to_string(state_->core->members().size()) +
                           " have joined");
        state_->changed.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kSliceNs)));
    }
    return {};
}

std::vector<MemberEvent> Group::takeEvents() {
    const std::lock_guard lock(state_->mutex);
    return std::exchange(state_->unreadEvents, {});
}

void Group::remove(MemberId id, const std::string& why) {
    const std::lock_guard lock(state_->mutex);
    state_->core->evict(id, GoneReason::Removed, why);
    state_->pump();
}

Result<MemberId> Group::accept(Deadline deadline) {
    std::unique_lock lock(state_->mutex);
    while (true) {
        for (const auto& [id, info] : state_->core->members()) {
            if (!state_->core->receiver(id) || state_->accepted.contains(id)) continue;
            state_->accepted.insert(id);
            return id;
        }
        if (!state_->failure.empty()) return Error{state_->failure};
        if (deadline.passed()) return tooLate("a member");
        state_->changed.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kSliceNs)));
    }
}

void Group::leave() { state_->stop(); }

Result<size_t> Group::writeSome(std::span<const std::byte> bytes, Deadline deadline) {
    std::unique_lock lock(state_->mutex);
    while (true) {
        if (!state_->failure.empty()) return Error{state_->failure};
        const size_t took = state_->core->sender()->write(bytes);
        if (took > 0 || bytes.empty()) {
            if (state_->core->sender()->canSend()) state_->pump();
            return took;
        }
        if (!state_->wait(lock, state_->room, deadline)) return tooLate("free space in the stream; a member is slow");
    }
}

Result<void> Group::write(std::span<const std::byte> bytes, Deadline deadline) {
    while (!bytes.empty()) {
        auto took = writeSome(bytes, deadline);
        if (!took) return took.error();
        bytes = bytes.subspan(*took);
    }
    return {};
}

void Group::flush() {
    const std::lock_guard lock(state_->mutex);
    state_->core->sender()->flush();
    state_->pump();
}

Result<void> Group::waitArrived(Deadline deadline) {
    std::unique_lock lock(state_->mutex);
    while (!state_->core->sender()->allArrived()) {
        if (!state_->failure.empty()) return Error{state_->failure};
        if (!state_->wait(lock, state_->arrived, deadline)) return tooLate("all members to acknowledge all data");
    }
    return {};
}

// Returns the readable pieces of a member's stream in place; waits for the first. 0: end of the stream.
Result<size_t> Group::State::readable(std::unique_lock<std::mutex>& lock, MemberId from,
                                      std::span<std::span<const std::byte>> pieces, Deadline deadline) {
    while (true) {
        const Receiver* r = core->receiver(from);
        if (const size_t count = r ? r->readable(pieces) : 0; count > 0) return count;
        if (!core->members().contains(from)) {
            core->forget(from);
            return size_t{0};
        }
        if (from == kHost && hostLeft) return size_t{0};
        if (!failure.empty()) return Error{failure};
        waitingForData.push_back(from);
        const bool inTime = wait(lock, data, deadline);
        waitingForData.erase(std::ranges::find(waitingForData, from)); // equal entries are interchangeable
        if (!inTime) return tooLate("data of member " + std::to_string(from));
    }
}

Result<size_t> Group::read(MemberId from, std::span<std::byte> into, Deadline deadline) {
    std::array<std::span<const std::byte>, kMaxPieces> pieces;
    std::unique_lock lock(state_->mutex);
    auto found = state_->readable(lock, from, pieces, deadline);
    if (!found) return found.error();
    Receiver* r = *found == 0 ? nullptr : state_->core->receiver(from);
    size_t done = 0;
    for (size_t count = *found; count > 0 && done < into.size(); count = r->readable(pieces)) {
        // Copying needs no lock: the bytes stay in place until consumed, while more arrive.
        lock.unlock();
        const size_t before = done;
        for (const auto piece : std::span(pieces).first(count)) {
            const size_t n = std::min(piece.size(), into.size() - done);
            if (n > 0) std::memcpy(into.data() + done, piece.data(), n);
            done += n;
        }
        lock.lock();
        r->consume(done - before);
    }
    if (r && r->hasUnreported()) state_->pump();
    return done;
}

Result<size_t> Group::view(MemberId from, std::span<std::span<const std::byte>> pieces, Deadline deadline) {
    std::unique_lock lock(state_->mutex);
    return state_->readable(lock, from, pieces, deadline);
}

void Group::consume(MemberId from, size_t bytes) {
    const std::lock_guard lock(state_->mutex);
    Receiver* r = state_->core->receiver(from);
    r->consume(bytes);
    if (r->hasUnreported()) state_->pump();
}

GroupReport Group::report() const {
    const std::lock_guard lock(state_->mutex);
    return state_->report();
}

} // namespace mural::rsp
