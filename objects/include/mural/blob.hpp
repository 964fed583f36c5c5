// Immutable bytes that processes of one machine share without copies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "common/base/result.hpp"

namespace mural {

// XXH3-128 of the contents. Equal names mean equal bytes.
using BlobName = std::array<std::byte, 16>;

// Immutable bytes, named by their content. Copies of a Blob share memory. Blobs of 64 KiB and more are sealed anonymous
// files (memfd), so other processes of the machine map the same pages. A node that has received a content before does
// not receive it again.
//
// Thread safety: all functions may be called from any thread. A Blob object is a value like std::shared_ptr.
class Blob {
public:
    // An empty blob.
    Blob() = default;

    // Copies `bytes`. Error: out of memory.
    static Result<Blob> copyOf(std::span<const std::byte> bytes);

    // Creates a blob of `sizeBytes` zeros, and calls `fill` once to write the contents in place, without a further
    // copy. Error: out of memory.
    static Result<Blob> make(size_t sizeBytes, const std::function<void(std::span<std::byte>)>& fill);

    // Maps a file. Reads it once, to name it. Requires that the file does not change while the blob exists. Errors: the
    // file is missing or not readable, or its size changes during the call.
    static Result<Blob> mapFile(const std::string& path);

    // Returns the contents; valid as long as a copy of the blob exists.
    [[nodiscard]] std::span<const std::byte> bytes() const;
    [[nodiscard]] size_t sizeBytes() const { return bytes().size(); } // of the contents
    [[nodiscard]] bool empty() const { return bytes().empty(); }      // whether there are no contents

    // Returns the contents as elements of a trivially copyable type. A rest smaller than one element is left out.
    // Requires the alignment of T from the contents' start, which is at least 16.
    template <class T> [[nodiscard]] std::span<const T> as() const {
        static_assert(std::is_trivially_copyable_v<T>, "Blob::as<T>() needs a trivially copyable T");
        static_assert(alignof(T) <= 16, "Blob::as<T>() needs a T with an alignment of at most 16");
        return {reinterpret_cast<const T*>(bytes().data()), bytes().size() / sizeof(T)};
    }

    [[nodiscard]] const BlobName& name() const; // of the contents
    // Whether the contents are equal; compares the names.
    friend bool operator==(const Blob& a, const Blob& b) { return a.name() == b.name(); }

    // Internal: the memory behind a blob (objects/blob/blob_memory.hpp).
    struct Memory;
    // Internal.
    explicit Blob(std::shared_ptr<const Memory> memory) : memory_(std::move(memory)) {}
    // Internal.
    [[nodiscard]] const std::shared_ptr<const Memory>& memory() const { return memory_; }

private:
    std::shared_ptr<const Memory> memory_; // null: empty
};

} // namespace mural
