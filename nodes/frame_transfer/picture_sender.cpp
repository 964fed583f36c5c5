#include "nodes/frame_transfer/picture_sender.hpp"

#include <algorithm>
#include <chrono>
#include <pthread.h>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/frame_spans/frame_spans_message.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/frame_transfer/transfer_scale.hpp"

namespace mural {

namespace {

constexpr size_t kMaxFrames = 2;              // one in encoding and one waiting
constexpr size_t kMinMeasuredBytes = 1 << 16; // smaller transfers measure socket buffers instead of the link

std::unique_ptr<PicturePacker> packerFor(const PictureSenderConfig& config) {
    return config.codec == kRawCodec ? nullptr : std::make_unique<PicturePacker>(config.codec, config.alpha);
}

} // namespace

PictureSender::PictureSender(PictureSenderConfig config, Send send)
    : config_(std::move(config)), send_(std::move(send)), packer_(packerFor(config_)), thread_([this] { run(); }) {
    if (pthread_getcpuclockid(thread_.native_handle(), &clock_) != 0) clock_ = CLOCK_THREAD_CPUTIME_ID;
}

PictureSender::~PictureSender() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join(); // every job terminates
}

int64_t PictureSender::cpuNs() const {
    timespec t{};
    clock_gettime(clock_, &t);
    return int64_t{t.tv_sec} * kNsPerS + t.tv_nsec;
}

// Returns false if the condition stays false for roomMs. The time of a message in transfer does not count: a paused
// head reads nothing, and its end closes the connection.
template <class Condition> bool PictureSender::await(std::unique_lock<std::mutex>& lock, Condition condition) {
    constexpr int64_t kSliceMs = 100;
    for (int64_t waitedMs = 0; !condition();) {
        const int64_t sliceMs = std::min(kSliceMs, config_.roomMs - waitedMs);
        if (sliceMs <= 0) return false;
        changed_.wait_for(lock, std::chrono::milliseconds(sliceMs));
        if (!sending_) waitedMs += sliceMs;
    }
    return true;
}

// A message larger than maxBytes waits until no other message is queued.
bool PictureSender::give(Job job, size_t bytes, bool isFrame) {
    std::unique_lock lock(mutex_);
    const auto room = [&] {
        return isFrame ? frames_ < kMaxFrames : waitingBytes_ == 0 || waitingBytes_ + bytes <= config_.maxBytes;
    };
    if (stuck_ || !await(lock, room)) {
        if (!std::exchange(stuck_, true))
            log::error(log::Topic::Picture, "no picture could be sent for ", config_.roomMs / 1000,
                       " s; the node ends");
        return false;
    }
    frames_ += isFrame ? 1 : 0;
    waitingBytes_ += bytes;
    jobs_.push_back(std::move(job));
    lock.unlock();
    changed_.notify_all();
    return true;
}

bool PictureSender::send(Frame frame) {
    Job job;
    job.frame = std::move(frame);
    return give(std::move(job), 0, true);
}

bool PictureSender::enqueue(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    bool alone = false;
    {
        const std::lock_guard lock(mutex_);
        if (stuck_) return false;
        alone = idle(); // remains true, because only this thread queues jobs
    }
    if (alone) {
        send_(type, a, b);
        return true;
    }
    Job job;
    job.message = Message{type, {a.begin(), a.end()}};
    job.message->bytes.insert(job.message->bytes.end(), b.begin(), b.end());
    const size_t bytes = job.message->bytes.size();
    return give(std::move(job), bytes, false);
}

void PictureSender::windowGone(uint32_t client, uint32_t window) {
    Job job;
    job.forgotten = Forgotten{client, window};
    (void)give(std::move(job), 0, false);
}

void PictureSender::clientGone(uint32_t client) {
    Job job;
    job.forgotten = Forgotten{client, std::nullopt};
    (void)give(std::move(job), 0, false);
}

bool PictureSender::finish() {
    std::unique_lock lock(mutex_);
    return !stuck_ && await(lock, [this] { return idle(); });
}

void PictureSender::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !jobs_.empty() || stop_; }); // the destructor ends the wait
        if (jobs_.empty()) return;
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        working_ = true;
        lock.unlock();
        const bool isFrame = job.frame.has_value();
        const size_t bytes = job.message ? job.message->bytes.size() : 0;
        work(job);
        job = {}; // frees the memory before the next picture is read
        lock.lock();
        working_ = false;
        frames_ -= isFrame ? 1 : 0;
        waitingBytes_ -= bytes;
        changed_.notify_all();
    }
}

void PictureSender::send(wire::NodeMessage type, std::span<const std::byte> a, std::span<const std::byte> b) {
    const SpanScope transfers(SpanKind::Transfer);
    sending_ = true;
    send_(type, a, b);
    sending_ = false;
}

void PictureSender::work(Job& job) {
    if (job.frame) return sendFrame(*job.frame);
    if (job.message) return send(job.message->type, job.message->bytes, {});
    if (job.forgotten) forget(*job.forgotten);
}

void PictureSender::forget(const Forgotten& forgotten) {
    if (!packer_) return;
    if (forgotten.window)
        packer_->windowGone(forgotten.client, *forgotten.window);
    else
        packer_->clientGone(forgotten.client);
}

// Sends a black picture if the readback fails, so that the frame still completes.
void PictureSender::sendFrame(Frame& frame) {
    const wire::PictureHeader& h = frame.header;
    recordThread(spans_, !frame.spans.empty(), SpanKind::WaitFrame);
    const SpanScope works(SpanKind::Compress);
    const int64_t beganCpuNs = threadCpuNowNs();
    auto read = bytesOf(*frame.picture);
    if (!read && !std::exchange(lossReported_, true))
        log::warning(
            log::Topic::Picture,
            "readback failed; this picture, and later ones after the same failure, are black: ", read.error().message);
    if (!read) black_.assign(static_cast<size_t>(h.w) * static_cast<size_t>(h.h) * 4, std::byte{0});
    std::span<const std::byte> pixels = read ? *read : black_;
    const int64_t beganNs = monotonicNowNs();
    const ScaledSize size = scaledSizeOf(h.w, h.h, config_.transferScale);
    if (!config_.transferScale.none()) {
        inTransfer_.resize(size.bytes());
        resizePicture(pixels.data(), h.w, h.h, inTransfer_.data(), size.w, size.h);
        pixels = inTransfer_;
    }
    int64_t packedNs = beganNs;
    sendPicture(h, size, pixels, packedNs);
    const int64_t tookCpuNs = threadCpuNowNs() - beganCpuNs;
    frame.done.readbackNs += static_cast<uint64_t>(tookCpuNs);
    if (config_.addsCpu)
        frame.done.busyNs += static_cast<uint64_t>(tookCpuNs);
    else
        frame.done.busyNs = std::max(frame.done.busyNs, static_cast<uint64_t>(packedNs - beganNs));
    sendSpans(frame);
    send(wire::NodeMessage::FrameDone, std::as_bytes(std::span(&frame.done, 1)), {});
}

Result<std::span<const std::byte>> PictureSender::bytesOf(PictureRead& picture) const {
    const SpanScope waits(SpanKind::WaitReadback);
    return picture.bytes(Deadline::inMs(config_.readMs));
}

// Sets `packedNs` to the end of the encoding; without encoding it stays as it is.
void PictureSender::sendPicture(const wire::PictureHeader& h, const ScaledSize& size, std::span<const std::byte> pixels,
                                int64_t& packedNs) {
    const auto header = std::as_bytes(std::span(&h, 1));
    if (!packer_) return send(wire::NodeMessage::Picture, header, pixels);
    auto packed = packer_->pack(h.client, h.window, size.w, size.h, pixels.data());
    packedNs = monotonicNowNs();
    if (!packed) return send(wire::NodeMessage::Picture, header, pixels); // out of memory
    send(wire::NodeMessage::PackedPicture, header, *packed);
    if (packed->size() >= kMinMeasuredBytes) packer_->transferred(packed->size(), monotonicNowNs() - packedNs);
}

void PictureSender::sendSpans(Frame& frame) {
    if (frame.spans.empty()) return;
    const int64_t nowNs = quickNowNs();
    addSpans(frame.spans, wire::SpanThread::Pictures, spans_.take(nowNs));
    const wire::FrameSpansHeader header{frame.done.client, frame.done.window, frame.done.frame, 0, nowNs};
    send(wire::NodeMessage::FrameSpans, std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(frame.spans)));
}

} // namespace mural
