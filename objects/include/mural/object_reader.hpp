// The readers' end of distributed objects.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <mural/archive.hpp>
#include <mural/ref.hpp>

#include "common/base/clock.hpp"

namespace mural {

namespace archive {

// An encoded object and the blobs that it refers to.
class EncodedObject : public BlobSource {
public:
    [[nodiscard]] virtual std::span<const std::byte> bytesOf(uint32_t slot) const = 0;
};

// How objects of a type are decoded; used by ObjectReader.
struct TypeOperations {
    const TypeLayout& layout;
    // Returns a copy of `previous`, or a new object if it is null, with the given slots decoded. An error begins with
    // the field.
    Result<std::shared_ptr<const void>> (*decode)(const void* previous, uint64_t slots, const EncodedObject& from);
};

template <class T> const TypeOperations& operationsOf() {
    static const TypeOperations operations{
        layoutOf<T>(),
        [](const void* previous, uint64_t slots, const EncodedObject& from) -> Result<std::shared_ptr<const void>> {
            auto object = previous ? std::make_shared<T>(*static_cast<const T*>(previous)) : std::make_shared<T>();
            const auto decoded = decodeSlots(*object, slots, &from, [&](uint32_t slot) { return from.bytesOf(slot); });
            if (!decoded) return decoded.error();
            return std::shared_ptr<const void>(std::move(object));
        }};
    return operations;
}

} // namespace archive

// Reads the objects of a session. Snapshots are immutable, and readers of one version share one snapshot.
//
// Thread safety: any thread.
class ObjectReader {
public:
    struct Core; // objects/ends/reader_core.hpp
    explicit ObjectReader(std::shared_ptr<Core> core) : core_(std::move(core)) {}

    // Returns the object at exactly the version of the reference, or its newest version for version 0. Waits until it
    // has arrived. Errors: the deadline, an unknown object, a version that is no longer kept, another type, damaged
    // bytes.
    template <class T> Result<Snapshot<T>> get(const Ref<T>& ref, Deadline deadline = Deadline::inMs(5000)) {
        return typed<T>(getAny(ref, archive::operationsOf<T>(), deadline));
    }

    // Returns the object if it has arrived, otherwise null, and requests it. Null also after an error.
    template <class T> [[nodiscard]] Snapshot<T> peek(const Ref<T>& ref) {
        return std::static_pointer_cast<const T>(peekAny(ref, archive::operationsOf<T>()));
    }

    // Returns the object of this type and name at the version that a frame uses. Waits and errors: get(). Requires that
    // the process has received the end of the frame's preparation.
    template <class T>
    Result<Snapshot<T>> stateAt(uint64_t frame, std::string_view name, Deadline deadline = Deadline::inMs(5000)) {
        return typed<T>(stateAtAny(frame, name, archive::operationsOf<T>(), deadline));
    }
    // The same for a reference; its version does not matter.
    template <class T>
    Result<Snapshot<T>> stateAt(uint64_t frame, const Ref<T>& ref, Deadline deadline = Deadline::inMs(5000)) {
        return typed<T>(stateAtAny(frame, ref, archive::operationsOf<T>(), deadline));
    }

    // Requests objects, in this order, that are delivered on demand.
    void prefetch(std::span<const AnyRef> refs);

private:
    using AnySnapshot = std::shared_ptr<const void>;
    template <class T> static Result<Snapshot<T>> typed(Result<AnySnapshot> any) {
        if (!any) return any.error();
        return std::static_pointer_cast<const T>(std::move(any.value()));
    }
    Result<AnySnapshot> getAny(const AnyRef& ref, const archive::TypeOperations& type, Deadline deadline);
    AnySnapshot peekAny(const AnyRef& ref, const archive::TypeOperations& type);
    Result<AnySnapshot> stateAtAny(uint64_t frame, std::string_view name, const archive::TypeOperations& type,
                                   Deadline deadline);
    Result<AnySnapshot> stateAtAny(uint64_t frame, const AnyRef& ref, const archive::TypeOperations& type,
                                   Deadline deadline);

    std::shared_ptr<Core> core_;
};

} // namespace mural
