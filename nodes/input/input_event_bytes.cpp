#include "nodes/input/input_event_bytes.hpp"

#include <algorithm>
#include <cmath>

namespace mural::input {

namespace {

constexpr size_t kMaxKeyText = 64;
constexpr size_t kMaxTypedText = 4096;
constexpr uint64_t kMaxSide = 32'767;
constexpr double kPlaceUnits = 1 << 30; // of the width or height of a picture
constexpr int kMaxWheelUnits = 120 * 100;
constexpr int kMaxEventButton = 9;
constexpr unsigned kHasPlace = 1, kIsDown = 2; // flags

uint64_t countOf(int value) { return static_cast<uint64_t>(std::max(value, 0)); }

uint64_t placeUnits(double value) { return static_cast<uint64_t>(std::clamp(value, 0.0, 1.0) * kPlaceUnits); }

uint64_t wheelUnits(double value) {
    return static_cast<uint64_t>(std::lround(std::clamp<double>(value, -kMaxWheelUnits, kMaxWheelUnits)) +
                                 kMaxWheelUnits);
}

double placeOf(objects::MessageReader& in) {
    return static_cast<double>(in.numberUpTo(static_cast<uint64_t>(kPlaceUnits))) / kPlaceUnits;
}

double wheelOf(objects::MessageReader& in) {
    return static_cast<double>(in.numberUpTo(2 * kMaxWheelUnits)) - kMaxWheelUnits;
}

} // namespace

void putEvent(objects::MessageWriter& out, const InputEvent& event) {
    out.byte(static_cast<uint8_t>(event.kind));
    out.number(event.number);
    out.byte(static_cast<uint8_t>((event.hasPlace ? kHasPlace : 0) | (event.isDown ? kIsDown : 0)));
    out.number(placeUnits(event.x)), out.number(placeUnits(event.y));
    out.number(countOf(event.button));
    out.number(wheelUnits(event.wheelX)), out.number(wheelUnits(event.wheelY));
    out.number(event.keysym);
    out.number(countOf(event.width)), out.number(countOf(event.height));
    out.text(event.key.substr(0, kMaxKeyText)), out.text(event.code.substr(0, kMaxKeyText));
    out.text(event.text.substr(0, kMaxTypedText));
}

InputEvent readEvent(objects::MessageReader& in) {
    InputEvent event;
    event.kind = static_cast<InputKind>(in.numberUpTo(static_cast<uint64_t>(InputKind::Close)));
    event.number = static_cast<uint32_t>(in.numberUpTo(UINT32_MAX));
    const uint64_t flags = in.numberUpTo(kHasPlace | kIsDown);
    event.hasPlace = (flags & kHasPlace) != 0;
    event.isDown = (flags & kIsDown) != 0;
    event.x = placeOf(in);
    event.y = placeOf(in);
    event.button = static_cast<int>(in.numberUpTo(kMaxEventButton));
    if (event.button < 1) in.fail();
    event.wheelX = wheelOf(in);
    event.wheelY = wheelOf(in);
    event.keysym = static_cast<uint32_t>(in.numberUpTo(UINT32_MAX));
    event.width = static_cast<int>(in.numberUpTo(kMaxSide));
    event.height = static_cast<int>(in.numberUpTo(kMaxSide));
    event.key = in.text(kMaxKeyText);
    event.code = in.text(kMaxKeyText);
    event.text = in.text(kMaxTypedText);
    return event;
}

std::vector<std::byte> bytesOfEvent(const InputEvent& event) {
    archive::ByteBuffer buffer;
    objects::MessageWriter out(buffer);
    putEvent(out, event);
    const auto bytes = buffer.bytes();
    return {bytes.begin(), bytes.end()};
}

Result<InputEvent> eventOfBytes(std::span<const std::byte> bytes) {
    objects::MessageReader in(bytes);
    InputEvent event = readEvent(in);
    if (!in.atEnd()) return Error{"it sent a malformed input event"};
    return event;
}

} // namespace mural::input
