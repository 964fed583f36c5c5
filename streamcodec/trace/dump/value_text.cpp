#include "streamcodec/trace/dump/value_text.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace mural::trace {
namespace {

constexpr size_t kMaxElements = 16;
constexpr size_t kMaxText = 120;
// Smaller enums without a group are usually numbers: components, levels, GL_ONE.
constexpr uint32_t kFirstUnambiguousEnum = 0x100;

template <class T> T load(const std::byte* at) {
    T value{};
    std::memcpy(&value, at, sizeof value);
    return value;
}

} // namespace

std::string enumText(uint16_t group, uint32_t value) {
    if (const char* name = group != 0 ? enumName(group, value) : nullptr) return name;
    if (const char* name = value >= kFirstUnambiguousEnum ? enumName(0, value) : nullptr) return name;
    return value < kFirstUnambiguousEnum ? std::to_string(value) : fmt::format("0x{:x}", value);
}

std::string bitsText(uint16_t group, uint32_t value) {
    if (value == 0 || group == 0) return value == 0 ? "0" : fmt::format("0x{:x}", value);
    if (const char* whole = enumName(group, value)) return whole;
    std::string text;
    uint32_t left = value;
    for (const EnumName& bit : enumNames(group)) {
        if (bit.value == 0 || (left & bit.value) != bit.value) continue;
        text += (text.empty() ? "" : "|") + std::string(bit.name);
        left &= ~bit.value;
    }
    if (left != 0) text += (text.empty() ? "" : "|") + fmt::format("0x{:x}", left);
    return text;
}

std::string numberText(Element element, uint16_t group, const std::byte* at) {
    switch (element) {
    case Element::Boolean: {
        const auto value = load<uint8_t>(at);
        return value > 1 ? std::to_string(value) : value == 1 ? "GL_TRUE" : "GL_FALSE";
    }
    case Element::Enum: return enumText(group, load<uint32_t>(at));
    case Element::Bits: return bitsText(group, load<uint32_t>(at));
    case Element::I8: return std::to_string(load<int8_t>(at));
    case Element::I16: return std::to_string(load<int16_t>(at));
    case Element::U16: return std::to_string(load<uint16_t>(at));
    case Element::I32: return std::to_string(load<int32_t>(at));
    case Element::U32: return std::to_string(load<uint32_t>(at));
    case Element::I64: return std::to_string(load<int64_t>(at));
    case Element::U64: return std::to_string(load<uint64_t>(at));
    case Element::F32: return fmt::format("{:.9g}", load<float>(at));
    case Element::F64: return fmt::format("{:.17g}", load<double>(at));
    case Element::Bytes:
    case Element::U8: break;
    }
    return std::to_string(load<uint8_t>(at));
}

std::string arrayText(Element element, uint16_t group, std::span<const std::byte> bytes) {
    if (element == Element::Bytes) return fmt::format("<{} bytes>", bytes.size());
    const size_t each = bytesOf(element), count = bytes.size() / each;
    std::string text = "[";
    for (size_t i = 0; i < std::min(count, kMaxElements); ++i)
        text += (i > 0 ? ", " : "") + numberText(element, group, bytes.data() + i * each);
    return text + (count > kMaxElements ? fmt::format(", … {} in all]", count) : "]");
}

std::string quoted(std::span<const std::byte> bytes) {
    std::string text = "\"";
    for (const std::byte byte : bytes.first(std::min(bytes.size(), kMaxText))) {
        const char c = static_cast<char>(byte);
        if (c == '\n')
            text += "\\n";
        else if (c == '"' || c == '\\')
            text += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 32 || c == 127)
            text += fmt::format("\\x{:02x}", static_cast<unsigned>(byte));
        else
            text += c;
    }
    return text + (bytes.size() > kMaxText ? fmt::format("…\" ({} bytes)", bytes.size()) : "\"");
}

} // namespace mural::trace
