// How rows of a picture part travel: the rectangles that were drawn, each with its colour and its depth packed by codecs.
// The bytes: docs/wire-format.md, "Parts of pictures".
#pragma once

#include <functional>
#include <span>

#include "common/result.hpp"
#include "compositor/strategies/schedule.hpp"
#include "nodes/exchange/part_fold.hpp"
#include "nodes/exchange/picture_part.hpp"
#include "nodes/pictures/plane_codecs.hpp"

namespace mural {

// Whether all is in it that its ranks have drawn, or a node was lost on the way.
enum class PartState : uint8_t { Complete, Incomplete };

// What of these rows is not as the clears have left it.
std::vector<std::byte> packPart(const PicturePart& part, const compositor::RowRange& rows, const FoldRule& rule, PartState state, PlaneEncoder& encoder);

// The most bytes that packPart makes of such rows.
[[nodiscard]] size_t boundBytesOf(const PixelViewport& box, const compositor::RowRange& rows);

// A rectangle that came: in the part's box, without gaps between its rows.
struct ArrivedPiece {
    PixelViewport area;
    const uint32_t* colour;
    const uint32_t* depth;
};
// Any bytes may come in. Errors: it is no such message, or of another picture or other rows; pieces before the damage have been told.
Result<PartState> unpackPart(std::span<const std::byte> message, const PictureId& id, const compositor::RowRange& rows, const FoldRule& rule, PlaneDecoder& decoder,
                             const std::function<void(const ArrivedPiece&)>& each);

} // namespace mural
