#include "objects/ends/object_writer.hpp"

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <random>

#include "objects/core/object_names.hpp"

namespace mural {

namespace archive {

EncodedSlots& scratchSlots() {
    static thread_local EncodedSlots slots;
    constexpr size_t kMostKeptBytes = size_t{16} << 20; // larger memory returns to the system
    if (slots.encoder.out().size() > kMostKeptBytes) slots = EncodedSlots();
    return slots;
}

} // namespace archive

namespace objects {

struct ObjectWriter::Core {
    Core(MessageSink& sink, const MasterOptions& options) : master(sink, options) {}

    std::mutex mutex;
    std::condition_variable progress; // a token arrived, a reader left, or the writer was closed
    ObjectMaster master;
    bool isClosed = false;
};

namespace {

constexpr int64_t kWaitSliceNs = 50'000'000; // bounds the error of deadlines that pause with the process

Uuid randomUuid() {
    static thread_local std::random_device random;
    Uuid id;
    for (size_t at = 0; at < id.size(); at += sizeof(unsigned)) {
        const unsigned bits = random();
        std::memcpy(id.data() + at, &bits, sizeof bits);
    }
    id[6] = (id[6] & std::byte{0x0f}) | std::byte{0x40}; // version 4, RFC 9562
    id[8] = (id[8] & std::byte{0x3f}) | std::byte{0x80};
    return id;
}

Error overFor(const std::string& name) { return {"cannot commit object \"" + name + "\": the session is over"}; }

class WriterObject final : public SharedObject {
public:
    WriterObject(std::shared_ptr<ObjectWriter::Core> core, ObjectNumber number, const Uuid& id, std::string name,
                 bool sendsWhole)
        : core_(std::move(core)), number_(number), ref_{id, 0}, name_(std::move(name)), sendsWhole_(sendsWhole) {}
    ~WriterObject() override {
        const std::lock_guard lock(core_->mutex);
        if (!core_->isClosed) core_->master.unshare(number_);
    }

    Result<Version> commit(const archive::EncodedSlots& slots, bool sendAll, Deadline deadline) override {
        if (slots.encoder.isTooLarge())
            return Error{"cannot commit object \"" + name_ + "\": a list has 2^32 elements or more; use mural::Blob"};
        uint64_t changed = 0;
        uint64_t hashes[archive::kMaxSlots];
        for (uint32_t i = 0; i < slots.count; ++i) {
            hashes[i] = archive::hashOf(slots.bytesOf(i));
            if (ref_.version == 0 || sendAll || hashes[i] != hashes_[i]) changed |= uint64_t{1} << i;
        }
        if (changed == 0) return ref_.version;
        if (sendsWhole_) changed = allSlots(slots.count);
        change_.slots = changed;
        change_.values.clear();
        for (uint32_t i = 0; i < slots.count; ++i)
            if ((changed >> i & 1) != 0) change_.values.push_back({slots.bytesOf(i), slots.blobsOf(i)});
        const Result<Version> version = publish(deadline);
        if (!version) return version.error();
        std::copy(hashes, hashes + slots.count, hashes_);
        ref_.version = version.value();
        return ref_.version;
    }

    [[nodiscard]] AnyRef ref() const override { return ref_; }

private:
    Result<Version> publish(Deadline deadline) {
        std::unique_lock lock(core_->mutex);
        while (!core_->isClosed) {
            const auto behind = core_->master.readerBehind(number_);
            if (!behind) return core_->master.commit(number_, change_);
            if (deadline.passed())
                return Error{"cannot commit object \"" + name_ + "\" within the deadline: " + *behind +
                             " has not read earlier versions; allow more by mostUnread"};
            core_->progress.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kWaitSliceNs)));
        }
        return overFor(name_);
    }

    const std::shared_ptr<ObjectWriter::Core> core_;
    const ObjectNumber number_;
    AnyRef ref_;
    const std::string name_;
    const bool sendsWhole_;                    // every commit has all slots
    uint64_t hashes_[archive::kMaxSlots] = {}; // XXH3-64 of the committed slots
    ObjectChange change_;
};

} // namespace

ObjectWriter::ObjectWriter(MessageSink& sink, const MasterOptions& options)
    : core_(std::make_shared<Core>(sink, options)) {}

ObjectWriter::~ObjectWriter() { close(); }

Result<std::unique_ptr<SharedObject>> ObjectWriter::shareAny(const archive::TypeLayout& layout,
                                                             const ShareOptions& options) {
    const std::lock_guard lock(core_->mutex);
    if (core_->isClosed) return overFor(options.name);
    const Uuid id = randomUuid();
    const Result<ObjectNumber> number = core_->master.share({id, options, layout});
    if (!number) return number.error();
    return std::unique_ptr<SharedObject>(
        std::make_unique<WriterObject>(core_, number.value(), id, options.name, options.sharing != Sharing::Delta));
}

void ObjectWriter::join(PeerId reader, const std::string& name) {
    const std::lock_guard lock(core_->mutex);
    if (!core_->isClosed) core_->master.join(reader, name);
}

void ObjectWriter::leave(PeerId reader) {
    {
        const std::lock_guard lock(core_->mutex);
        core_->master.leave(reader);
    }
    core_->progress.notify_all();
}

Result<void> ObjectWriter::input(PeerId reader, std::span<const std::byte> message, int64_t nowNs) {
    Result<void> result;
    {
        const std::lock_guard lock(core_->mutex);
        if (!core_->isClosed) result = core_->master.input(reader, message, nowNs);
    }
    core_->progress.notify_all();
    return result;
}

void ObjectWriter::tick(int64_t nowNs) {
    const std::lock_guard lock(core_->mutex);
    if (!core_->isClosed) core_->master.tick(nowNs);
}

void ObjectWriter::frame(uint64_t number) {
    const std::lock_guard lock(core_->mutex);
    core_->master.frame(number);
}

void ObjectWriter::frameDone(uint64_t number) {
    const std::lock_guard lock(core_->mutex);
    core_->master.frameDone(number);
}

void ObjectWriter::close() {
    {
        const std::lock_guard lock(core_->mutex);
        core_->isClosed = true;
    }
    core_->progress.notify_all();
}

} // namespace objects
} // namespace mural
