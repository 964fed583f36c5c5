// The names and record layout of each GL command's arguments, for tools that print records. Generated from the
// registry, as the decoders are.
#pragma once

#include <cstdint>
#include <span>

namespace mural {

enum class Travel : uint8_t {
    Scalar, // widened to 4 bytes in the record
    Wide,   // 8 bytes: handles, offsets into buffers
    Fixed,  // an array of fixedBytes
    Value,  // a variable-size value (docs/reference/wire-format.md)
    Text,   // a value with text
    Texts,  // a value with a list of strings
};

// The type of a parameter, or of an array's elements.
enum class Element : uint8_t { Bytes, Boolean, Enum, Bits, I8, U8, I16, U16, I32, U32, I64, U64, F32, F64 };
constexpr unsigned bytesOf(Element e) {
    switch (e) {
    case Element::I16:
    case Element::U16: return 2;
    case Element::Enum:
    case Element::Bits:
    case Element::I32:
    case Element::U32:
    case Element::F32: return 4;
    case Element::I64:
    case Element::U64:
    case Element::F64: return 8;
    default: return 1;
    }
}

struct ParameterInfo {
    const char* name;
    Travel travel;
    Element element;
    uint16_t fixedBytes; // for Fixed
    uint16_t group;      // of enums and bits; 0: not in the registry
};

struct CommandParameters {
    std::span<const ParameterInfo> parameters; // in record order
    uint8_t resultBytes = 0;                   // size of the driver-generated name after the parameters
};
CommandParameters parametersOf(uint16_t opcode);

struct EnumName {
    uint16_t group;
    uint32_t value;
    const char* name;
};
// All names of the group, sorted by value, with core GL names preferred. Group 0: all enums that are not bits.
std::span<const EnumName> enumNames(uint16_t group);
const char* enumName(uint16_t group, uint32_t value); // null: none

} // namespace mural
