// The queues of a process: they add types, threads and waiting to the state machines. A queue is known by its name.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <mural/queue.hpp>

#include "objects/core/message_sink.hpp"

namespace mural::objects {

// The queues that this process adds items to. Thread safety: any thread. The sink is called with a lock held, and must
// live until close().
class QueueHub {
public:
    explicit QueueHub(MessageSink& sink);
    ~QueueHub() { close(); }
    QueueHub(const QueueHub&) = delete;
    QueueHub& operator=(const QueueHub&) = delete;

    // Opens the queue of this name. Readers may request items before. The hub forgets a queue after its end and the end
    // of its last QueueMaster; readers that ask afterwards receive the end, unless the name was opened again.
    template <class T> QueueMaster<T> open(std::string_view name) { return QueueMaster<T>(openAny(name)); }
    std::shared_ptr<AnyQueueMaster> openAny(std::string_view name);

    // Applies an Ask or a Done.
    Result<void> input(PeerId reader, std::span<const std::byte> message);
    // The reader is lost or leaves. Its messages must not be passed on afterwards.
    void leave(PeerId reader);
    void close();

    struct Core;

private:
    std::shared_ptr<Core> core_;
};

// The queues that this process reads. Thread safety: any thread. The sink is called with a lock held, and must live
// until close(). Its messages go to peer kWriter.
class QueueLine {
public:
    explicit QueueLine(MessageSink& sink);
    ~QueueLine() { close(); }
    QueueLine(const QueueLine&) = delete;
    QueueLine& operator=(const QueueLine&) = delete;

    // Opens the queue of this name, once per process.
    template <class T> QueueReader<T> open(std::string_view name) { return QueueReader<T>(openAny(name)); }
    std::shared_ptr<AnyQueueReader> openAny(std::string_view name);

    // Sets the function that waiting calls receive by (ReaderEnd::waitBy).
    void waitBy(std::function<bool(Deadline)> receive);
    // Applies an Item or a Closed.
    Result<void> input(std::span<const std::byte> message, int64_t nowNs);
    // Makes waiting calls return an error.
    void close();

    struct Core;

private:
    std::shared_ptr<Core> core_;
};

// Returns the number of a queue or barrier in messages.
uint32_t numberOfName(std::string_view name);

} // namespace mural::objects
