#include "tools/mural/page/protocol/picture_part.hpp"

#include <concepts>

namespace mural::page {

namespace {

template <std::unsigned_integral Number> void appendLittleEndian(std::string& to, Number value) {
    for (size_t i = 0; i < sizeof value; ++i) to.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

} // namespace

std::string partHeaderBytes(const PartHeader& header, size_t payloadBytes) {
    std::string message;
    message.reserve(kPartHeaderBytes);
    message.push_back(static_cast<char>(kPartVersion));
    message.push_back(static_cast<char>(header.kind));
    appendLittleEndian(message, header.flags);
    appendLittleEndian(message, header.stream);
    appendLittleEndian(message, header.frame);
    appendLittleEndian(message, header.lastInput);
    for (const uint16_t value :
         {header.x, header.y, header.width, header.height, header.pictureWidth, header.pictureHeight})
        appendLittleEndian(message, value);
    appendLittleEndian(message, static_cast<uint32_t>(payloadBytes));
    return message;
}

} // namespace mural::page
