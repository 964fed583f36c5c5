#include "nodes/replay/features/list_sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include <GL/gl.h>

#include "streamcodec/command_effects.hpp"
#include "streamcodec/command_parameters.hpp"
#include "streamcodec/command_traits.hpp"

namespace mural::replay {

namespace {

enum class ListedUse : uint8_t { State, Begin, End, Position, OtherVertex, Attribute };

struct ListedCommand {
    ListedUse use = ListedUse::State;
    uint8_t components = 0; // of a position
    Element element{};      // of its components
    bool isArray = false;   // the components are an array
    uint8_t selectors = 0;  // leading arguments that select the attribute
    bool hasIndex = false;  // the first of them is the index of a generic attribute
};

bool isIndex(const ParameterInfo& parameter) { return std::string_view(parameter.name) == "index"; }

ListedCommand describe(uint16_t opcode) {
    ListedCommand command;
    const std::span<const ParameterInfo> parameters = parametersOf(opcode).parameters;
    if (hasTrait(opcode, Trait::Begin)) {
        command.use = ListedUse::Begin;
    } else if (hasTrait(opcode, Trait::End)) {
        command.use = ListedUse::End;
    } else if (hasTrait(opcode, Trait::Position) && !parameters.empty()) {
        command.use = ListedUse::Position;
        command.element = parameters[0].element;
        command.isArray = parameters[0].travel == Travel::Fixed;
        command.components = static_cast<uint8_t>(command.isArray ? parameters[0].fixedBytes / bytesOf(command.element)
                                                                  : parameters.size());
    } else if (hasTrait(opcode, Trait::Vertex)) {
        command.use = ListedUse::OtherVertex;
    } else if (effectOf(opcode).kind == EffectKind::Attribute || effectOf(opcode).kind == EffectKind::Color) {
        command.use = ListedUse::Attribute;
        command.hasIndex = !parameters.empty() && isIndex(parameters[0]);
        for (const ParameterInfo& p : parameters.first(std::min<size_t>(2, parameters.size()))) {
            if (p.travel != Travel::Scalar || (p.element != Element::Enum && !isIndex(p))) break;
            ++command.selectors;
        }
    }
    return command;
}

const ListedCommand& listedCommand(uint16_t opcode) {
    static const std::vector<ListedCommand> commands = [] {
        std::vector<ListedCommand> all;
        for (uint32_t i = 0; i < op::kLimit; ++i) all.push_back(describe(static_cast<uint16_t>(i)));
        return all;
    }();
    static constexpr ListedCommand kNone;
    return opcode < op::kLimit ? commands[opcode] : kNone;
}

uint32_t listedWord(std::span<const std::byte> arguments, size_t index) {
    uint32_t word = 0;
    if (arguments.size() >= 4 * (index + 1)) std::memcpy(&word, arguments.data() + 4 * index, 4);
    return word;
}

template <class T> double coordinateAt(const std::byte* at) {
    T value{};
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

// The coordinate, or NaN if the record is too short or the type has no bounds. Scalars are widened to 4 bytes.
double coordinateOf(const ListedCommand& command, std::span<const std::byte> arguments, size_t index) {
    const size_t bytes = bytesOf(command.element), step = command.isArray ? bytes : std::max<size_t>(bytes, 4);
    if (arguments.size() < step * index + bytes) return NAN;
    const std::byte* const at = arguments.data() + step * index;
    switch (command.element) {
    case Element::I16: return coordinateAt<int16_t>(at);
    case Element::I32: return coordinateAt<int32_t>(at);
    case Element::F32: return coordinateAt<float>(at);
    case Element::F64: return coordinateAt<double>(at);
    default: return NAN;
    }
}

float floatBelow(double value) {
    const auto rounded = static_cast<float>(value);
    return double{rounded} > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}
float floatAbove(double value) { return -floatBelow(-value); }

// Attributes of different groups are independent: colours, materials, and others.
uint32_t groupOf(uint16_t opcode) {
    const CommandEffect& effect = effectOf(opcode);
    if (effect.kind == EffectKind::Color) return 1;
    return effect.attribBits & GL_LIGHTING_BIT ? 2 : 4;
}

} // namespace

void ListSection::take(uint16_t opcode, std::span<const std::byte> arguments) {
    const ListedCommand& command = listedCommand(opcode);
    if (command.use == ListedUse::Attribute) {
        addAttribute(opcode, arguments);
    } else if (command.use == ListedUse::Begin && !isInPrimitive_) {
        const uint32_t mode = listedWord(arguments, 0);
        ++begins_;
        isInPrimitive_ = mode <= GL_POLYGON;
        isForeign_ = isForeign_ || !isInPrimitive_;
        primitives_.modes |= mode <= GL_POLYGON ? 1U << mode : 0U;
    } else if (command.use == ListedUse::Position && isInPrimitive_) {
        addPosition(opcode, arguments);
    } else if (command.use == ListedUse::End && isInPrimitive_) {
        isInPrimitive_ = false;
    } else {
        isForeign_ = true;
    }
}

// Mesa leaves behind the last value outside of primitives where a list sets an attribute outside and inside.
bool ListSection::isPlain() const {
    return primitives_.vertices > 0 && !isForeign_ && !isInPrimitive_ && (groupsBefore_ & groupsInside_) == 0;
}

void ListSection::addPosition(uint16_t opcode, std::span<const std::byte> arguments) {
    const ListedCommand& command = listedCommand(opcode);
    for (size_t i = 0; i < 4; ++i) {
        const double value = i < command.components ? coordinateOf(command, arguments, i) : i == 3 ? 1 : 0;
        if (!(std::abs(value) <= std::numeric_limits<float>::max())) isForeign_ = true;
        const bool isFirst = primitives_.vertices == 0;
        primitives_.lowest[i] = isFirst ? floatBelow(value) : std::min(primitives_.lowest[i], floatBelow(value));
        primitives_.highest[i] = isFirst ? floatAbove(value) : std::max(primitives_.highest[i], floatAbove(value));
    }
    ++primitives_.vertices;
}

// An attribute that a list sets for the first time after its first vertex has an unknown value at the vertices before.
// Drivers then play the list as glBegin, and join it with its neighbours.
void ListSection::addAttribute(uint16_t opcode, std::span<const std::byte> arguments) {
    const ListedCommand& command = listedCommand(opcode);
    std::array<uint32_t, 2> selectors{};
    for (size_t i = 0; i < command.selectors; ++i) selectors[i] = listedWord(arguments, i);
    const bool isVertex = command.hasIndex && selectors[0] == 0; // the generic attribute 0
    isForeign_ = isForeign_ || isVertex || (begins_ > 0 && !isInPrimitive_);
    (isInPrimitive_ ? groupsInside_ : groupsBefore_) |= groupOf(opcode);
    std::vector<ListedAttribute>& attributes = isInPrimitive_ ? inside_ : before_;
    const auto known = std::ranges::find_if(
        attributes, [&](const ListedAttribute& a) { return a.opcode == opcode && a.selectors == selectors; });
    if (known == attributes.end()) {
        isForeign_ = isForeign_ || primitives_.vertices > 0;
        attributes.push_back({opcode, selectors, {arguments.begin(), arguments.end()}});
        return;
    }
    known->arguments.assign(arguments.begin(), arguments.end());
    if (known + 1 != attributes.end()) std::rotate(known, known + 1, attributes.end());
}

} // namespace mural::replay
