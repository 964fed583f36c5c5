// The state behind an ObjectReader: a mirror, and the snapshots that were decoded from it.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>

#include <mural/object_reader.hpp>

#include "objects/core/object_mirror.hpp"

namespace mural {

struct ObjectReader::Core {
    Core(objects::MessageSink& sink, const objects::BlobIntakeOptions& options) : mirror(sink, options) {}

    // The snapshots of one object. Decoding holds `mutex`, but not the mutex of the mirror.
    struct Snapshots {
        struct Entry {
            objects::StatePointer state;
            AnySnapshot snapshot;
        };
        std::mutex mutex;
        const archive::TypeOperations* type = nullptr; // of the entries
        std::vector<Entry> entries;                    // the last made one is the last
    };

    // A state that a caller may decode, or the reason why there is none.
    struct Lookup {
        objects::ObjectMirror::Presence presence = objects::ObjectMirror::Presence::Unknown;
        objects::StatePointer state;
        std::shared_ptr<Snapshots> snapshots;
        std::string object;  // for messages
        std::string problem; // another type; empty: none
    };
    // Requires the lock.
    Lookup lookUp(const objects::ObjectMirror::Found& found, const archive::TypeOperations& type);

    // Returns the snapshot of a state: an existing one, or a copy of the previous one with the changed slots decoded.
    static Result<AnySnapshot> decode(const Lookup& lookup, const archive::TypeOperations& type);

    // Waits until find(ref) reports a state. find() runs with the lock, and sets `ref` to the version to request.
    template <class Find> Result<AnySnapshot> wait(Find&& find, const archive::TypeOperations& type, Deadline deadline);

    // Drops the snapshots of ended objects. Requires the lock.
    void forgetEnded();

    // Receives further messages while a caller waits, if the waiting thread is the one that receives. Waits until the
    // deadline. Returns false if no message will come. Empty: another thread receives.
    std::function<bool(Deadline)> receive;
    std::mutex mutex;
    std::condition_variable arrival;
    objects::ObjectMirror mirror;
    std::map<Uuid, std::shared_ptr<Snapshots>> snapshots;
    bool isClosed = false;
};

namespace objects {

// The owner of an ObjectReader: feeds it with messages.
//
// Thread safety: any thread. The sink is called with a lock held and must not call back.
class ReaderEnd {
public:
    // Messages to the writer go to peer kWriter of `sink`, which must live until close().
    explicit ReaderEnd(MessageSink& sink, const BlobIntakeOptions& options = {});
    ~ReaderEnd() { close(); }
    ReaderEnd(const ReaderEnd&) = delete;
    ReaderEnd& operator=(const ReaderEnd&) = delete;

    [[nodiscard]] ObjectReader& reader() { return reader_; }

    // ObjectMirror has the descriptions.
    Result<void> input(std::span<const std::byte> message, int64_t nowNs);
    void tick(int64_t nowNs);
    void frame(uint64_t number);
    void frameDone(uint64_t number);

    // Sets the function that waiting calls receive by. Call before the first of them; all calls then belong to the
    // thread that feeds this end.
    void waitBy(std::function<bool(Deadline)> receive);
    // Makes waiting calls return an error. Snapshots stay valid.
    void close();

private:
    std::shared_ptr<ObjectReader::Core> core_;
    ObjectReader reader_;
};

} // namespace objects
} // namespace mural
