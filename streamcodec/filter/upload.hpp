// A parsed upload: the part of its object that it writes, and its shape. Two uploads of one shape are valid or invalid
// alike, and the later overwrites everything of the earlier.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "streamcodec/wire/record_walk.hpp"

struct XXH3_state_s;

namespace mural::filter {

// Texture: an image; buffer: a range.
struct Place {
    uint32_t target = 0, level = 0;
    uint64_t begin = 0, end = UINT64_MAX;
    [[nodiscard]] bool overlaps(const Place& o) const {
        return target == o.target && level == o.level && begin < o.end && o.begin < end;
    }
    bool operator==(const Place&) const = default;
};

// Everything in the record except the value, and the length of the value.
struct Shape {
    std::array<uint32_t, 16> words{};
    uint64_t valueBytes = 0;
    bool operator==(const Shape&) const = default;
};

enum class UploadKind : uint8_t {
    Whole,   // replaces the image or buffer, including its size
    Part,    // replaces a part
    Storage, // allocates new storage: earlier contents are irrelevant if it succeeds, which is unknown here
};

struct Upload {
    UploadKind kind = UploadKind::Part;
    Place place;
    Shape shape;
    std::span<const std::byte> inlineValue; // the inline part
    bool given = false;                     // has data; false: only a size, or the data is in a buffer
};

// Parses a record of class Upload. blobBytes: size of its blob, 0: none. Returns an empty value for unknown forms.
std::optional<Upload> uploadOf(const wire::RecordView& r, uint64_t blobBytes);

// XXH3, 128 bits, over consecutive pieces. Equal sums count as equal data: among 10^9 different pieces the probability
// of a collision is below 2^-64.
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

} // namespace mural::filter
