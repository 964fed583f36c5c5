// The writer's end of a distributed object.
#pragma once

#include <memory>
#include <utility>

#include <mural/archive.hpp>
#include <mural/ref.hpp>
#include <mural/sharing.hpp>

#include "common/base/clock.hpp"

namespace mural {

// A shared object without its type; used by Shared<T>. The object ends with it.
class SharedObject {
public:
    virtual ~SharedObject() = default;
    // Commits the slots that differ from the last commit, or all.
    virtual Result<Version> commit(const archive::EncodedSlots& slots, bool sendAll, Deadline deadline) = 0;
    [[nodiscard]] virtual AnyRef ref() const = 0;
};

namespace archive {
// Returns memory for the encoding of an object, one per thread.
EncodedSlots& scratchSlots();
} // namespace archive

// The writer's own copy of an object, and the means to publish it. Readers see it at commit() only. Destruction ends
// the object for its readers; their snapshots stay valid.
//
// Thread safety: one thread at a time per object; different objects are independent.
template <class T> class Shared {
public:
    // Used by the session.
    Shared(std::unique_ptr<SharedObject> object, T value) : object_(std::move(object)), value_(std::move(value)) {}

    // Returns the copy for changes. The reference stays valid as long as this Shared is not moved.
    [[nodiscard]] T& edit() { return value_; }
    // Returns the copy.
    [[nodiscard]] const T& get() const { return value_; }

    // Makes the next commit send all fields.
    void touch() { sendsAll_ = true; }

    // Publishes the fields that changed since the last commit. Returns the new version, or the last one if nothing
    // changed. Waits for readers that are mostUnread commits behind. Errors: the deadline, which names the reader; the
    // session is over; a field is too large.
    Result<Version> commit(Deadline deadline = Deadline::inMs(5000)) {
        archive::EncodedSlots& slots = archive::scratchSlots();
        archive::encodeSlots(value_, slots);
        Result<Version> version = object_->commit(slots, sendsAll_, deadline);
        if (version) sendsAll_ = false;
        return version;
    }

    // Returns a reference to the last committed version.
    [[nodiscard]] Ref<T> ref() const { return {object_->ref()}; }
    [[nodiscard]] Version version() const { return object_->ref().version; } // 0 before the first commit

private:
    std::unique_ptr<SharedObject> object_;
    T value_;
    bool sendsAll_ = false;
};

} // namespace mural
