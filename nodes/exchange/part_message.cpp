#include "nodes/exchange/part_message.hpp"

#include <algorithm>
#include <string>

#include "common/base/little_endian.hpp"
#include "compositor/image/region_of_interest.hpp"

namespace mural {

namespace {

using compositor::PlaneFormat;
using compositor::PlaneView;
using compositor::RowRange;

// Coarser than the compositor's tiles: each piece has a header, and codecs favour wide pieces.
constexpr int32_t kTilePixels = 64;
constexpr size_t kHeadBytes = 48, kPieceBytes = 28;

// A decoded piece fits into a core's cache until it is folded.
constexpr int32_t kPieceColumns = 512, kPieceRows = 128;

PlaneFormat colourFormatOf(const CompositeRule& rule) {
    return rule.hasHalfFloats ? PlaneFormat::Rgba16F : PlaneFormat::Rgba8;
}

// 32-bit integer depths are encoded as opaque words, which a lossless codec permits.
PlaneFormat depthFormatOf(const CompositeRule& rule) { return rule.deep ? PlaneFormat::D32F : PlaneFormat::D24S8; }

void put32(std::vector<std::byte>& into, int64_t value) {
    into.resize(into.size() + 4);
    storeLittle(into.data() + into.size() - 4, static_cast<uint32_t>(value));
}
void put64(std::vector<std::byte>& into, uint64_t value) {
    put32(into, static_cast<int64_t>(value & 0xffffffffu));
    put32(into, static_cast<int64_t>(value >> 32));
}
int32_t int32At(std::span<const std::byte> bytes, size_t at) {
    return static_cast<int32_t>(loadLittle<uint32_t>(bytes.data() + at));
}

PlaneView viewOf(const std::vector<uint32_t>& words, const PicturePart& part, PlaneFormat format) {
    return {format, part.id.box.w, part.id.box.h,
            static_cast<ptrdiff_t>(part.id.box.w) * static_cast<ptrdiff_t>(bytesPerPixel(format)),
            reinterpret_cast<const std::byte*>(words.data())};
}

std::vector<PixelViewport> piecesOf(const compositor::Region& drawn) {
    std::vector<PixelViewport> pieces;
    for (const PixelViewport& r : drawn.rectangles())
        for (int32_t y = 0; y < r.h; y += kPieceRows)
            for (int32_t x = 0; x < r.w; x += kPieceColumns)
                pieces.push_back({r.x + x, r.y + y, std::min(kPieceColumns, r.w - x), std::min(kPieceRows, r.h - y)});
    return pieces;
}

} // namespace

std::vector<std::byte> packPart(const PicturePart& part, const RowRange& rows, const CompositeRule& rule,
                                PartState state, PlaneEncoder& encoder) {
    const PixelViewport band{0, rows.first, part.id.box.w, rows.count()};
    const PlaneView colour = viewOf(part.colour, part, colourFormatOf(rule)).part(band);
    const auto background = compositor::Background::ofWord(rule.clearedColour);
    PlaneView depth;
    if (!rule.blends) depth = viewOf(part.depth, part, depthFormatOf(rule)).part(band);
    const compositor::Region drawn =
        rule.blends ? findRegionOfInterest(colour, background, kTilePixels)
                    : findRegionOfInterest(colour, background, depth, compositor::Background::ofWord(rule.clearedDepth),
                                           kTilePixels);
    const std::vector<PixelViewport> pieces = piecesOf(drawn);
    std::vector<std::byte> message;
    put32(message, part.id.client);
    put64(message, part.id.serial);
    for (const int32_t v : {part.id.box.x, part.id.box.y, part.id.box.w, part.id.box.h, rows.first, rows.end})
        put32(message, v);
    put32(message, static_cast<int64_t>(state));
    put32(message, part.order);
    put32(message, static_cast<int64_t>(pieces.size()));
    for (const PixelViewport& r : pieces) {
        const size_t head = message.size();
        for (const int32_t v : {r.x, rows.first + r.y, r.w, r.h}) put32(message, v);
        message.resize(head + kPieceBytes);
        const size_t colourAt = message.size();
        message[head + 16] = std::byte{encoder.encode(colour.part(r), message)};
        const size_t depthAt = message.size();
        if (!rule.blends) message[head + 17] = std::byte{encoder.encode(depth.part(r), message)};
        storeLittle(message.data() + head + 20, static_cast<uint32_t>(depthAt - colourAt));
        storeLittle(message.data() + head + 24, static_cast<uint32_t>(message.size() - depthAt));
    }
    return message;
}

size_t boundBytesOf(const PixelViewport& box, const RowRange& rows) {
    const auto tiles = [](int32_t pixels) { return static_cast<size_t>((pixels + kTilePixels - 1) / kTilePixels); };
    return kHeadBytes + tiles(box.w) * tiles(rows.count()) * kPieceBytes +
           static_cast<size_t>(box.w) * static_cast<size_t>(rows.count()) * 8;
}

Result<PartHead> unpackPart(std::span<const std::byte> message, const PictureId& id, const RowRange& rows,
                            const CompositeRule& rule, PlaneDecoder& decoder,
                            const std::function<void(const ArrivedPiece&)>& each) {
    const auto damaged = [](const std::string& what) {
        return Error{"invalid message with a part of a picture: " + what};
    };
    if (message.size() < kHeadBytes) return damaged("it is shorter than its header");
    const PictureId came{loadLittle<uint32_t>(message.data()),
                         loadLittle<uint64_t>(message.data() + 4),
                         {int32At(message, 12), int32At(message, 16), int32At(message, 20), int32At(message, 24)}};
    if (came != id || RowRange{int32At(message, 28), int32At(message, 32)} != rows)
        return Error{"parts of different pictures arrived together; this picture is incomplete"};
    PartHead head;
    head.state = int32At(message, 36) == 0 ? PartState::Complete : PartState::Incomplete;
    head.order = loadLittle<uint32_t>(message.data() + 40);
    const uint32_t pieces = loadLittle<uint32_t>(message.data() + 44);
    const PixelViewport band{0, rows.first, id.box.w, rows.count()};
    int64_t left = band.area(); // valid pieces do not overlap: rejects messages that decode to more
    std::vector<uint32_t>&colour = decoder.colour(), &depth = decoder.depth();
    std::span<const std::byte> rest = message.subspan(kHeadBytes);
    for (uint32_t i = 0; i < pieces; ++i) {
        if (rest.size() < kPieceBytes) return damaged("it ends before its last piece");
        const PixelViewport area{int32At(rest, 0), int32At(rest, 4), int32At(rest, 8), int32At(rest, 12)};
        const auto colourCodec = std::to_integer<CodecNumber>(rest[16]),
                   depthCodec = std::to_integer<CodecNumber>(rest[17]);
        const size_t colourBytes = loadLittle<uint32_t>(rest.data() + 20),
                     depthBytes = loadLittle<uint32_t>(rest.data() + 24);
        rest = rest.subspan(kPieceBytes);
        if (area.empty() || !band.contains(area) || area.area() > left)
            return damaged("a piece lies outside of the part");
        if (colourBytes > rest.size() || depthBytes > rest.size() - colourBytes)
            return damaged("it ends before its last piece");
        left -= area.area();
        const auto pixels = static_cast<size_t>(area.area());
        colour.resize(pixels * rule.colourWords());
        if (!rule.blends) depth.resize(pixels);
        const auto unpack = [&](CodecNumber codec, size_t from, size_t bytes, PlaneFormat format,
                                std::vector<uint32_t>& into) {
            return decoder.decode(codec, rest.subspan(from, bytes),
                                  {format, area.w, area.h,
                                   static_cast<ptrdiff_t>(area.w) * static_cast<ptrdiff_t>(bytesPerPixel(format)),
                                   reinterpret_cast<std::byte*>(into.data())});
        };
        if (auto r = unpack(colourCodec, 0, colourBytes, colourFormatOf(rule), colour); !r)
            return damaged(r.error().message);
        if (rule.blends) {
            if (depthBytes != 0) return damaged("a piece has depth, although the parts are blended");
        } else if (auto r = unpack(depthCodec, colourBytes, depthBytes, depthFormatOf(rule), depth); !r) {
            return damaged(r.error().message);
        }
        each({area, colour.data(), rule.blends ? nullptr : depth.data()});
        rest = rest.subspan(colourBytes + depthBytes);
    }
    if (!rest.empty()) return damaged("it is longer than its pieces");
    return head;
}

} // namespace mural
