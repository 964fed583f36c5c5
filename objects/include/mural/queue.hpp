// Work queues: one process adds items, and each item goes to one reader.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <mural/archive.hpp>

#include "common/base/clock.hpp"

namespace mural {

// The ends of a queue without the type of its items; used by QueueMaster and QueueReader.
class AnyQueueMaster {
public:
    virtual ~AnyQueueMaster() = default;
    virtual Result<void> push(std::span<const std::byte> item, uint64_t frame) = 0;
    virtual void clear() = 0;
    virtual void close() = 0;
    [[nodiscard]] virtual size_t size() const = 0;
};

class AnyQueueReader {
public:
    virtual ~AnyQueueReader() = default;
    // Returns the bytes of the next item; empty: closed and all items are finished.
    virtual Result<std::optional<std::vector<std::byte>>> pop(Deadline deadline) = 0;
    [[nodiscard]] virtual const std::string& name() const = 0;
};

// The adding end. Thread safety: any thread.
template <class T> class QueueMaster {
public:
    // Used by the session.
    explicit QueueMaster(std::shared_ptr<AnyQueueMaster> queue) : queue_(std::move(queue)) {}

    // Appends an item. `frame`: the frame that it belongs to, 0 for none. Errors: the queue is closed; the item
    // contains a Blob, which must be in a shared object with a Ref to it in the item.
    Result<void> push(const T& item, uint64_t frame = 0) {
        archive::Encoder encoder;
        encoder.plain(archive::layoutOf<T>().hash);
        archive::Codec<T>::encode(encoder, item);
        if (!encoder.blobs().empty() || encoder.isTooLarge())
            return Error{"cannot add to a queue: the item contains a Blob or a list of 2^32 elements; share it as an "
                         "object, and put its Ref into the item"};
        return queue_->push(encoder.out().bytes(), frame);
    }
    // Drops the items that no reader has received.
    void clear() { queue_->clear(); }
    // Ends the queue after its last item.
    void close() { queue_->close(); }
    // Returns the number of items that no reader has received.
    [[nodiscard]] size_t size() const { return queue_->size(); }

private:
    std::shared_ptr<AnyQueueMaster> queue_;
};

// A reading end. Requests items ahead of their use. Thread safety: one thread at a time.
template <class T> class QueueReader {
public:
    // Used by the session.
    explicit QueueReader(std::shared_ptr<AnyQueueReader> queue) : queue_(std::move(queue)) {}

    // Returns the next item, and reports the one before as finished. Waits for an item. Empty: the queue is closed and
    // all of its items are finished. An item whose reader is lost before it finishes goes to another reader.
    // Errors: the deadline, another type, the session is over.
    Result<std::optional<T>> pop(Deadline deadline = Deadline::inMs(5000)) {
        auto bytes = queue_->pop(deadline);
        if (!bytes) return bytes.error();
        if (!bytes.value()) return std::optional<T>();
        archive::Decoder decoder(*bytes.value());
        uint64_t hash = 0;
        decoder.plain(hash);
        if (hash != archive::layoutOf<T>().hash) decoder.fail("has another type");
        std::optional<T> item(std::in_place);
        archive::Codec<T>::decode(decoder, *item);
        if (decoder.ok() && decoder.left() == 0) return item;
        return Error{"cannot read an item of queue \"" + queue_->name() + "\" as " + archive::layoutOf<T>().typeName +
                     ": it has another type or is damaged; build all processes from the same sources"};
    }

private:
    std::shared_ptr<AnyQueueReader> queue_;
};

} // namespace mural
