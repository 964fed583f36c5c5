// XXH3 over several pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace mural::trace {

uint64_t checksumOf(std::initializer_list<std::span<const std::byte>> pieces);

// Returns the fields of a part before its checksum.
template <class Part> std::span<const std::byte> beforeChecksum(const Part& part) {
    return std::as_bytes(std::span(&part, 1)).first(offsetof(Part, checksum));
}

} // namespace mural::trace
