#include "nodes/head/capture/capture_client.hpp"

#include <chrono>
#include <cstring>
#include <fstream>
#include <system_error>

#include "nodes/head/broadcast/bytes_of.hpp"
#include "nodes/head/capture/liveness_mark.hpp"
#include "streamcodec/wire/object_records.hpp"
#include "streamcodec/wire/packet.hpp"

namespace mural {
namespace {

constexpr int64_t kPumpSliceNs = 50 * kNsPerMs;     // interval of the check whether the program has ended
constexpr int64_t kValuePatienceNs = 20 * kNsPerMs; // wait for the rest of a value that nodes can't use alone
constexpr size_t kFlushBytes = size_t{64} * 1024;   // nodes start on partial data of this size
constexpr size_t kMaxQueuedBytes = size_t{1} << 31; // limit of replies that the program does not read

std::string nameOf(pid_t pid) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/comm");
    std::string name;
    std::getline(file, name);
    return name.empty() ? "unknown" : name;
}

} // namespace

CaptureClient::CaptureClient(uint32_t id, pid_t pid, capture::ProgramKind kind, std::unique_ptr<CaptureMemory> memory,
                             StreamBroadcaster& nodes, CaptureEvents& events, FrameStatistics* statistics,
                             SentFrames* sentFrames)
    : id_(id),
      pid_(pid),
      kind_(kind),
      name_(nameOf(pid)),
      memory_(std::move(memory)),
      nodes_(nodes),
      events_(events),
      spans_(statistics, id, *memory_),
      sentFrames_(sentFrames),
      frames_(id) {}

CaptureClient::~CaptureClient() {
    stop();
    if (pumpThread_.joinable()) pumpThread_.join();
    if (replyThread_.joinable()) replyThread_.join();
}

Result<void> CaptureClient::start(FileDescriptor socket) {
    socket_ = std::move(socket);
    memory_->passed();
    try {
        replyThread_ = std::thread([this] { writeReplies(); });
        pumpThread_ = std::thread([this] { pump(); });
    } catch (const std::system_error& e) {
        stop();
        memory_->setHeadGone();
        pumpEnded_ = true;
        return Error{std::string("cannot create threads for it: ") + e.what() + "; raise ulimit -u"};
    }
    return {};
}

std::string CaptureClient::describe() const {
    return "program " + std::to_string(id_) + " (" + name_ + ", pid " + std::to_string(pid_) + ")";
}

void CaptureClient::drain() {
    drainTail_ = memory_->publishedTail();
    draining_ = true;
    memory_->wakePump();
}

void CaptureClient::stop() {
    stop_ = true;
    memory_->wakePump();
    const std::lock_guard lock(mutex_); // the writer is then either before its check of stop_ or asleep
    replyQueued_.notify_all();
}

void CaptureClient::detectEnd() {
    if (programGone()) memory_->wakePump();
}

void CaptureClient::drop(const std::string& problem) {
    {
        const std::lock_guard lock(mutex_);
        if (problem_.empty()) problem_ = problem;
    }
    stop();
}

void CaptureClient::pump() {
    CaptureMemory::Range range;
    bool gone = false;
    while (!stop_ && !drained()) {
        if (pumpNext(range)) {
            arrived_ = true;
            continue;
        }
        flushNodes(!arrived_ && monotonicNowNs() - arrivedNs_ >= kValuePatienceNs);
        spans_.sent();
        if (stop_ || gone) break; // gone: no publication has arrived since the program's end was detected
        gone = programGone();
        if (gone) continue;
        nodes_.sendScheduled();
        waitForMore();
    }
    flushNodes();
    const bool inOrder = drained() && !gone && !stop_;
    if (!inOrder) reportEnd();
    pumpEnded_ = true;
}

void CaptureClient::waitForMore() {
    const int64_t nowNs = monotonicNowNs();
    if (arrived_) {
        pace_.arrived(nowNs);
        arrivedNs_ = nowNs;
    }
    arrived_ = false;
    const bool soon = pace_.moreSoon(nowNs);
    const SpanScope waits(SpanKind::WaitProgram);
    memory_->waitPublished(soon ? capture::Reader::Naps : capture::Reader::Sleeps,
                           soon ? capture::kNapNs : kPumpSliceNs);
}

void CaptureClient::reportEnd() {
    std::string problem;
    {
        const std::lock_guard lock(mutex_);
        problem = problem_;
    }
    if (!problem.empty()) memory_->setHeadGone(); // the program continues without Mural
    events_.programEnded(id_, problem);
}

void CaptureClient::send(const CaptureMemory::Range& range) {
    const uint32_t stream = wire::streamOf(id_, range.stream);
    unflushedBytes_ += range.bytes.size();
    if (kind_ == capture::ProgramKind::Native && range.stream != wire::kToAllNodes)
        return nodes_.sendToNode(range.stream - wire::toNode(0), stream, range.bytes);
    nodes_.broadcast(stream, range.bytes);
    bytesSent_.fetch_add(range.bytes.size(), std::memory_order_relaxed);
    if (sentFrames_ && sentFrames_->areWanted)
        if (const auto frame = frames_.published(range.stream, range.bytes)) sentFrames_->add(*frame);
}

bool CaptureClient::pumpNext(CaptureMemory::Range& range) {
    const CaptureMemory::Next next = memory_->next(range);
    if (next == CaptureMemory::Next::Empty) return false;
    if (next == CaptureMemory::Next::Bad) {
        drop("its shared memory contains an invalid index; the program may have overwritten it");
        return false;
    }
    spans_.published(range.bytes);
    if (!range.bytes.empty()) send(range);
    if (!memory_->take(range)) {
        drop("it returned more chunks than it received; the program may have overwritten its shared memory");
        return false;
    }
    if (unflushedBytes_ >= kFlushBytes) flushNodes(false);
    return true;
}

// Flushes the packets to the nodes. Unless `all` is set, an incomplete value may stay until more data arrives.
void CaptureClient::flushNodes(bool all) {
    if (unflushedBytes_ == 0) return;
    if (all) nodes_.flush();
    if (all || nodes_.flushActionable()) unflushedBytes_ = 0;
}

bool CaptureClient::drained() const {
    return draining_ && static_cast<int32_t>(memory_->takenHead() - drainTail_) >= 0;
}

bool CaptureClient::programGone() const { return memory_->programGone(); }

void CaptureClient::reply(Reply reply) {
    if (reply.header.kind != capture::kPictureReply && (reply.header.requestId & capture::kPrefetched) != 0) {
        uint64_t value = 0;
        if (reply.bytes.size() >= sizeof value) std::memcpy(&value, reply.bytes.data(), sizeof value);
        return memory_->answerAhead(reply.header.requestId, value);
    }
    const std::lock_guard lock(mutex_);
    replyQueueBytes_ += reply.bytes.size();
    if (replyQueueBytes_ > kMaxQueuedBytes) {
        if (problem_.empty()) problem_ = "it requests data that it does not read; more than 2 GiB are queued";
        stop_ = true;
        return;
    }
    replies_.push_back(std::move(reply));
    replyQueued_.notify_one();
}

void CaptureClient::writeReplies() {
    const LivenessMark mark(memory_->livenessWord());
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (replies_.empty()) {
            replyQueued_.wait_for(lock, std::chrono::seconds(1));
            continue;
        }
        const Reply reply = std::move(replies_.front());
        replies_.pop_front();
        replyQueueBytes_ -= reply.bytes.size();
        lock.unlock();
        const bool written = writeAll(bytesOf(reply.header)) && writeAll(reply.bytes.span());
        if (written && reply.written) reply.written();
        lock.lock();
        if (!written) return;
    }
}

// Returns false if the program is gone or was dropped, or if the session ends. There is no deadline: a paused program
// reads the rest when it continues, and a partial reply would be useless. kMaxQueuedBytes bounds the queue.
bool CaptureClient::writeAll(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const size_t written = memory_->writeReply(bytes);
        bytes = bytes.subspan(written);
        if (written > 0) continue;
        if (stop_ || programGone()) return false;
        memory_->waitReplyRoom(kPumpSliceNs);
    }
    return true;
}

} // namespace mural
