#include "objects/ends/queue_ends.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>

#include "objects/core/object_names.hpp"
#include "objects/queue/queue_master.hpp"
#include "objects/queue/queue_reader.hpp"

namespace mural::objects {

namespace {

constexpr size_t kMaxQueues = 4096;               // requests may name queues that do not exist yet
constexpr int64_t kQueueWaitSliceNs = 50'000'000; // bounds the error of deadlines that pause with the process

Error queueOver(const std::string& name) { return {"queue \"" + name + "\": the session is over"}; }

} // namespace

uint32_t numberOfName(std::string_view name) { return static_cast<uint32_t>(archive::hashOf(name)); }

struct QueueHub::Core {
    explicit Core(MessageSink& theSink) : sink(theSink) {}
    ObjectQueueMaster& master(uint32_t queue) { return masters.try_emplace(queue, sink, queue).first->second; }

    std::mutex mutex;
    MessageSink& sink;
    // Forgets a queue that has ended and that no QueueMaster uses. Requires the mutex.
    void forgetIfEnded(uint32_t queue) {
        const auto found = masters.find(queue);
        if (found == masters.end() || !found->second.hasEnded() || handles[queue] > 0) return;
        masters.erase(found);
        handles.erase(queue);
        ended.push_back(queue);
        if (ended.size() > kMaxQueues) ended.pop_front();
    }

    std::map<uint32_t, ObjectQueueMaster> masters;
    std::map<uint32_t, uint32_t> handles; // number of HubQueues
    std::deque<uint32_t> ended;           // the latest
    bool isClosed = false;
};

namespace {

class HubQueue final : public AnyQueueMaster {
public:
    HubQueue(std::shared_ptr<QueueHub::Core> core, std::string_view name)
        : core_(std::move(core)), name_(name), number_(numberOfName(name)) {
        const std::lock_guard lock(core_->mutex);
        ++core_->handles[number_];
        core_->master(number_);
    }
    ~HubQueue() override {
        const std::lock_guard lock(core_->mutex);
        --core_->handles[number_];
        core_->forgetIfEnded(number_);
    }

    Result<void> push(std::span<const std::byte> item, uint64_t frame) override {
        const std::lock_guard lock(core_->mutex);
        if (core_->isClosed) return queueOver(name_);
        return core_->master(number_).push(item, frame);
    }
    void clear() override {
        const std::lock_guard lock(core_->mutex);
        if (!core_->isClosed) core_->master(number_).clear();
    }
    void close() override {
        const std::lock_guard lock(core_->mutex);
        if (!core_->isClosed) core_->master(number_).close();
    }
    [[nodiscard]] size_t size() const override {
        const std::lock_guard lock(core_->mutex);
        return core_->master(number_).size();
    }

private:
    const std::shared_ptr<QueueHub::Core> core_;
    const std::string name_;
    const uint32_t number_;
};

} // namespace

QueueHub::QueueHub(MessageSink& sink) : core_(std::make_shared<Core>(sink)) {}

std::shared_ptr<AnyQueueMaster> QueueHub::openAny(std::string_view name) {
    return std::make_shared<HubQueue>(core_, name);
}

Result<void> QueueHub::input(PeerId reader, std::span<const std::byte> bytes) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    const auto* const ask = std::get_if<AskMessage>(&*message);
    const auto* const done = std::get_if<DoneMessage>(&*message);
    if (!ask && !done) return unexpectedMessage(*message, "the writer of queues");
    const std::lock_guard lock(core_->mutex);
    if (core_->isClosed) return {};
    const uint32_t queue = ask ? ask->queue : done->queue;
    if (!core_->masters.contains(queue) && std::ranges::find(core_->ended, queue) != core_->ended.end()) {
        if (ask) MessageSender(core_->sink).toOne(reader, ClosedMessage{queue});
        return {};
    }
    if (core_->masters.size() >= kMaxQueues && !core_->masters.contains(queue))
        return Error{"reader " + std::to_string(reader) + " requests items of a queue that does not exist, beside " +
                     std::to_string(kMaxQueues) + " others; the request is ignored"};
    auto taken = ask ? core_->master(queue).input(reader, *ask) : core_->master(queue).input(reader, *done);
    core_->forgetIfEnded(queue);
    return taken;
}

void QueueHub::leave(PeerId reader) {
    const std::lock_guard lock(core_->mutex);
    if (core_->isClosed) return;
    std::vector<uint32_t> queues;
    for (auto& [number, master] : core_->masters) {
        master.leave(reader);
        queues.push_back(number);
    }
    for (const uint32_t queue : queues) core_->forgetIfEnded(queue);
}

void QueueHub::close() {
    const std::lock_guard lock(core_->mutex);
    core_->isClosed = true;
}

struct QueueLine::Core {
    explicit Core(MessageSink& theSink) : sink(theSink) {}

    std::mutex mutex;
    std::condition_variable arrival;
    MessageSink& sink;
    std::map<uint32_t, ObjectQueueReader> readers;
    std::function<bool(Deadline)> receive; // see QueueLine::waitBy
    bool isClosed = false;
};

namespace {

class LineQueue final : public AnyQueueReader {
public:
    LineQueue(std::shared_ptr<QueueLine::Core> core, std::string_view name)
        : core_(std::move(core)), name_(name), number_(numberOfName(name)) {}

    Result<std::optional<std::vector<std::byte>>> pop(Deadline deadline) override {
        std::unique_lock lock(core_->mutex);
        for (;;) {
            if (core_->isClosed) return queueOver(name_);
            ObjectQueueReader& reader = core_->readers.try_emplace(number_, core_->sink, number_).first->second;
            if (auto item = reader.pop(monotonicNowNs())) return std::optional(std::move(item->bytes));
            if (reader.hasEnded()) {
                core_->readers.erase(number_); // a later request is answered by Closed again
                return std::optional<std::vector<std::byte>>();
            }
            if (deadline.passed())
                return Error{"queue \"" + name_ +
                             "\": no item has arrived within the deadline; wait longer, or close it"};
            const int64_t sliceNs = deadline.leftNs(kQueueWaitSliceNs);
            if (core_->receive) {
                lock.unlock();
                const bool mayArrive = core_->receive(Deadline::inMs(sliceNs / kNsPerMs + 1));
                lock.lock();
                if (!mayArrive) return queueOver(name_);
                continue;
            }
            core_->arrival.wait_for(lock, std::chrono::nanoseconds(sliceNs));
        }
    }
    [[nodiscard]] const std::string& name() const override { return name_; }

private:
    const std::shared_ptr<QueueLine::Core> core_;
    const std::string name_;
    const uint32_t number_;
};

} // namespace

QueueLine::QueueLine(MessageSink& sink) : core_(std::make_shared<Core>(sink)) {}

std::shared_ptr<AnyQueueReader> QueueLine::openAny(std::string_view name) {
    const std::lock_guard lock(core_->mutex);
    core_->readers.try_emplace(numberOfName(name), core_->sink, numberOfName(name));
    return std::make_shared<LineQueue>(core_, name);
}

Result<void> QueueLine::input(std::span<const std::byte> bytes, int64_t nowNs) {
    const auto message = decode(bytes);
    if (!message) return damagedMessage(bytes);
    const auto* const item = std::get_if<ItemMessage>(&*message);
    const auto* const closed = std::get_if<ClosedMessage>(&*message);
    if (!item && !closed) return unexpectedMessage(*message, "a reader of queues");
    {
        const std::lock_guard lock(core_->mutex);
        const auto found = core_->readers.find(item ? item->queue : closed->queue);
        if (found == core_->readers.end() || core_->isClosed) return {};
        if (item) found->second.input(*item, nowNs);
        if (closed) found->second.input(*closed);
    }
    core_->arrival.notify_all();
    return {};
}

void QueueLine::waitBy(std::function<bool(Deadline)> receive) { core_->receive = std::move(receive); }

void QueueLine::close() {
    {
        const std::lock_guard lock(core_->mutex);
        core_->isClosed = true;
    }
    core_->arrival.notify_all();
}

} // namespace mural::objects
