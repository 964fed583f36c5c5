// The message format for rows of a picture part: the drawn rectangles with encoded colour and depth. Layout:
// docs/reference/wire-format.md, "Parts of pictures".
#pragma once

#include <functional>
#include <span>

#include "common/base/result.hpp"
#include "compositor/strategies/schedule.hpp"
#include "nodes/exchange/part_composition.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/frame_transfer/plane_codecs.hpp"

namespace mural {

// Incomplete: a lost node's contribution is missing.
enum class PartState : uint8_t { Complete, Incomplete };

// Encodes the rectangles of these rows that differ from the clear values. Parts that are blended have no depth.
std::vector<std::byte> packPart(const PicturePart& part, const compositor::RowRange& rows, const CompositeRule& rule,
                                PartState state, PlaneEncoder& encoder);

// Upper bound of the size of packPart's result.
[[nodiscard]] size_t boundBytesOf(const PixelViewport& box, const compositor::RowRange& rows);

// A received rectangle inside the part's box, with contiguous rows.
struct ArrivedPiece {
    PixelViewport area;
    const uint32_t* colour;
    const uint32_t* depth; // null: the parts are blended
};
struct PartHead {
    PartState state = PartState::Complete;
    uint32_t order = 0; // PicturePart::order of the sender
};
// Accepts arbitrary bytes. Errors: a malformed message; another picture or other rows. Pieces before the damage have
// been delivered.
Result<PartHead> unpackPart(std::span<const std::byte> message, const PictureId& id, const compositor::RowRange& rows,
                            const CompositeRule& rule, PlaneDecoder& decoder,
                            const std::function<void(const ArrivedPiece&)>& each);

} // namespace mural
