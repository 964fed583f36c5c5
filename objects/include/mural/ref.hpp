// References to distributed objects, and the type of their immutable states.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace mural {

// Identifies an object in all processes of a session.
using Uuid = std::array<std::byte, 16>;

// Number of a committed state of an object: 1, 2, 3, ... without gaps. In references, 0 means the newest version.
using Version = uint64_t;

// A state of an object. It never changes, may be used by any thread, and stays valid after the session's end.
template <class T> using Snapshot = std::shared_ptr<const T>;

// Names one version of an object of any type.
struct AnyRef {
    Uuid id{};           // all zero: refers to nothing
    Version version = 0; // 0: the newest

    [[nodiscard]] bool isNull() const { return id == Uuid{}; } // whether it refers to nothing
    // Whether both name the same version of the same object.
    friend bool operator==(const AnyRef&, const AnyRef&) = default;
};

// Names one version of an object of type T. Travels inside other objects in place of a pointer.
template <class T> struct Ref : AnyRef {
    // Whether both name the same version of the same object.
    friend bool operator==(const Ref&, const Ref&) = default;
};

} // namespace mural
