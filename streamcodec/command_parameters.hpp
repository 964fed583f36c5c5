// How the arguments of each GL command travel in a record, and what they are called: for readers that print records.
// Made from the registry, as the decoders are.
#pragma once

#include <cstdint>
#include <span>

namespace mural {

enum class Travel : uint8_t {
    Scalar, // in the record, widened to 4 bytes
    Wide,   // 8 bytes: handles, offsets into buffers
    Fixed,  // an array of fixedBytes
    Value,  // a value of variable size (docs/wire-format.md)
    Text,   // a value that is a text
    Texts,  // a value that is a list of strings
};

// What a parameter is, or each element of an array.
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
    uint16_t fixedBytes; // Fixed
    uint16_t group;      // of enums and bits; 0: the registry does not say
};

struct CommandParameters {
    std::span<const ParameterInfo> parameters; // in the order of the record
    uint8_t resultBytes = 0;                   // of the name that the driver has made, behind them
};
CommandParameters parametersOf(uint16_t opcode);

struct EnumName {
    uint16_t group;
    uint32_t value;
    const char* name;
};
// All of the group, by value; of each value the name that core GL has for it, if it has one. Group 0: all that are not bits.
std::span<const EnumName> enumNames(uint16_t group);
const char* enumName(uint16_t group, uint32_t value); // null: there is none

} // namespace mural
