// Feeds arbitrary bytes to the reader of parts of pictures. Reported rows lie within the expected rows and fit their
// contents. An accepted part can be composited, and sent on without loss.
#include <algorithm>

#include "common/base/little_endian.hpp"
#include "nodes/exchange/part_composition.hpp"
#include "tests/fuzz/exchange/part_input.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {

namespace {

constexpr size_t kNameBytes = 36; // client, serial, box, rows

void giveName(std::vector<std::byte>& message, const ExpectedPart& e) {
    if (message.size() < kNameBytes) return;
    const uint32_t words[] = {e.id.client,
                              static_cast<uint32_t>(e.id.serial),
                              static_cast<uint32_t>(e.id.serial >> 32),
                              static_cast<uint32_t>(e.id.box.x),
                              static_cast<uint32_t>(e.id.box.y),
                              static_cast<uint32_t>(e.id.box.w),
                              static_cast<uint32_t>(e.id.box.h),
                              static_cast<uint32_t>(e.rows.first),
                              static_cast<uint32_t>(e.rows.end)};
    for (size_t i = 0; i < std::size(words); ++i) storeLittle(message.data() + 4 * i, words[i]);
}

PicturePart clearedPart(const ExpectedPart& e) {
    PicturePart part;
    part.id = e.id;
    const auto pixels = static_cast<size_t>(e.id.box.area());
    part.colour.assign(pixels * e.rule.colourWords(), e.rule.clearedColour);
    part.depth.assign(pixels, e.rule.clearedDepth);
    return part;
}

// Unpacks into the part, as nodes do. Returns nothing if it was rejected.
std::optional<PartHead> unpackInto(PicturePart& part, const std::vector<std::byte>& message, const ExpectedPart& e) {
    static PlaneDecoder decoder; // keeps its scratch memory, as in the product
    int64_t pixels = 0;
    const PixelViewport band{0, e.rows.first, e.id.box.w, e.rows.count()};
    auto state = unpackPart(message, e.id, e.rows, e.rule, decoder, [&](const ArrivedPiece& piece) {
        must(!piece.area.empty() && band.contains(piece.area), "a piece lies in the rows that were waited for");
        pixels += piece.area.area();
        for (int32_t y = 0; y < piece.area.h; ++y) {
            const size_t from = static_cast<size_t>(y) * static_cast<size_t>(piece.area.w),
                         at = part.at(piece.area.x, piece.area.y + y);
            must((piece.depth == nullptr) == e.rule.blends, "blended parts have no depth, and others have");
            const size_t words = e.rule.colourWords();
            CompositeRow row{part.colour.data() + at * words, nullptr, piece.colour + from * words, nullptr,
                             static_cast<size_t>(piece.area.w)};
            if (!e.rule.blends) {
                row.depth = part.depth.data() + at;
                row.otherDepth = piece.depth + from;
            }
            compositeRow(row, LayerOrder::Later, e.rule);
        }
    });
    must(pixels <= band.area(), "pieces are no more than the rows hold");
    if (state) return *state;
    must(!state.error().message.empty() && state.error().message.find('\n') == std::string::npos,
         "an error is one line");
    return std::nullopt;
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    if (input.size() < kPartHeadBytes) return 0;
    InputReader in(input);
    const ExpectedPart expected = readExpectedPart(in);
    std::vector<std::byte> message(input.begin() + kPartHeadBytes, input.end()); // a copy of exactly this size
    if (expected.named) giveName(message, expected);
    PicturePart part = clearedPart(expected);
    const auto state = unpackInto(part, message, expected);
    if (!state) return 0;
    static PlaneEncoder encoder;
    part.order = state->order;
    const std::vector<std::byte> again = packPart(part, expected.rows, expected.rule, state->state, encoder);
    must(again.size() <= boundBytesOf(expected.id.box, expected.rows), "a message is not larger than its bound");
    PicturePart copy = clearedPart(expected);
    const auto second = unpackInto(copy, again, expected);
    must(second && second->state == state->state && second->order == state->order, "what was taken can be sent on");
    must(copy.colour == part.colour && copy.depth == part.depth, "nothing is lost on the way");
    return 1;
}

} // namespace mural::fuzz
