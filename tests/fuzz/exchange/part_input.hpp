// Input of part_fuzz: the composition of the nodes (1 byte), width (2), height, first row and rows (1 each), then the
// received message.
#pragma once

#include "nodes/exchange/part_message.hpp"
#include "tests/fuzz/network/input_reader.hpp"

namespace mural::fuzz {

constexpr int32_t kMaxPartColumns = 300; // more than four tiles
constexpr int32_t kMaxPartRows = 140;
constexpr size_t kPartHeadBytes = 6;

struct ExpectedPart {
    PictureId id;
    compositor::RowRange rows;
    CompositeRule rule;
    bool named = false; // the message receives the name of the expected picture, so that the rest of it is parsed
};

inline ExpectedPart readExpectedPart(InputReader& in) {
    constexpr compositor::DepthFunction kOrders[] = {
        compositor::DepthFunction::Less, compositor::DepthFunction::LessOrEqual, compositor::DepthFunction::Greater,
        compositor::DepthFunction::GreaterOrEqual};
    const unsigned how = in.byte();
    const bool less = how % 4 < 2;
    ExpectedPart e;
    e.rule = {kOrders[how % 4], 0xff102030u, less ? 0xffffffffu : 0u, (how & 4) != 0};
    e.named = (how & 8) != 0;
    e.rule.blends = (how & 16) != 0;
    if (e.rule.blends) e.rule.clearedColour = 0;
    e.rule.hasHalfFloats = e.rule.blends && (how & 32) != 0;
    const int32_t width = in.half() % kMaxPartColumns + 1, height = in.byte() % kMaxPartRows + 1;
    e.id = {3, 7, {5, 9, width, height}};
    e.rows.first = in.byte() % height;
    e.rows.end = e.rows.first + 1 + in.byte() % (height - e.rows.first);
    return e;
}

} // namespace mural::fuzz
