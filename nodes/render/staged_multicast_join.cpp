#include "nodes/render/staged_multicast_join.hpp"

#include <utility>

#include "transport/rsp/group_connection.hpp"

namespace mural {
namespace {

constexpr int64_t kGroupJoinMs = 10'000;
constexpr int64_t kSliceMs = 50;               // interval of the check for goOn()
constexpr size_t kMaxBytes = size_t{64} << 20; // far above the head's output before goOn()
constexpr size_t kReadBytes = size_t{64} << 10;

} // namespace

StagedMulticastJoin::StagedMulticastJoin(rsp::GroupOptions options, std::function<void(const std::string&)> failed)
    : options_(std::move(options)), failed_(std::move(failed)), thread_([this] { work(); }) {}

StagedMulticastJoin::~StagedMulticastJoin() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void StagedMulticastJoin::work() {
    auto group = rsp::Group::join(options_, Deadline::inMs(kGroupJoinMs));
    if (!group) return failed_(group.error().message);
    group_ = std::move(*group);
    while (!stop_ && come_.size() < kMaxBytes)
        if (!readSome()) return;
    if (stop_) return;
    group_.reset(); // leaves the group, so that the writer does not wait
    failed_("the head sent no stream position for the switch to multicast");
}

// Returns false after the end of the stream.
bool StagedMulticastJoin::readSome() {
    const size_t had = come_.size();
    come_.resize(had + kReadBytes);
    const Deadline slice = Deadline::inMs(kSliceMs);
    auto got = group_->read(rsp::kHost, std::span(come_).subspan(had), slice);
    come_.resize(had + (got ? *got : 0));
    return got ? *got > 0 : slice.passed();
}

Result<std::unique_ptr<Connection>> StagedMulticastJoin::goOn(uint64_t skipBytes, Deadline deadline) {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    if (!group_) return Error{"it is not a member of the group"};
    while (come_.size() < skipBytes) {
        skipBytes -= come_.size();
        come_.clear();
        if (deadline.passed()) return Error{"the beginning of its stream did not arrive in time"};
        if (!readSome()) return Error{"the group has ended"};
    }
    come_.erase(come_.begin(), come_.begin() + static_cast<std::ptrdiff_t>(skipBytes));
    return rsp::streamOfHost(std::move(group_), options_, std::move(come_));
}

} // namespace mural
