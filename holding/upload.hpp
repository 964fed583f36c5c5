// An upload, taken apart: which part of its object it writes, and in what shape. Two of one shape are valid or not alike, and the
// later replaces all that the earlier has written.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "recording/record_walk.hpp"

struct XXH3_state_s;

namespace mural::holding {

// Of a texture: an image of it; of a buffer: a range.
struct Place {
    uint32_t target = 0, level = 0;
    uint64_t begin = 0, end = UINT64_MAX;
    [[nodiscard]] bool overlaps(const Place& o) const { return target == o.target && level == o.level && begin < o.end && o.begin < end; }
    bool operator==(const Place&) const = default;
};

// All of the record but the value, and how long that is.
struct Shape {
    std::array<uint32_t, 16> words{};
    uint64_t valueBytes = 0;
    bool operator==(const Shape&) const = default;
};

enum class UploadKind : uint8_t {
    Whole,   // all of the place is new, its size, too
    Part,    // bytes of the place
    Storage, // the object gets other storage: nothing before counts, but nobody here knows that it succeeds
};

struct Upload {
    UploadKind kind = UploadKind::Part;
    Place place;
    Shape shape;
    std::span<const std::byte> inlineValue; // what lies in the record
    bool given = false;                     // it has bytes of the program's; false: only a size, or they lie in a buffer
};

// Of a record of class Upload; blobBytes: of the value that travels ahead of it, 0 when none does. Nothing: not of a form that is known.
std::optional<Upload> uploadOf(const recording::RecordView& r, uint64_t blobBytes);

// Of bytes that are given one after another. 128 bits of XXH3: what has the same sum is taken as the same: of a
// thousand million different ones, two are alike with a chance below 2^-64.
struct Sum {
    uint64_t low = 0, high = 0;
    bool operator==(const Sum&) const = default;
};
class Summing {
public:
    Summing();
    Summing(const Summing&) = delete;
    Summing& operator=(const Summing&) = delete;
    ~Summing();
    void add(std::span<const std::byte> bytes);
    [[nodiscard]] Sum sum() const;

private:
    XXH3_state_s* state_;
};

} // namespace mural::holding
