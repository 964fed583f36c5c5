// Native display lists that hold nothing but primitives and their attributes. A node may leave out such a list as a
// whole (docs/architecture/culling.md). No GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mural::replay {

// The primitives of a native list, with bounds of their positions.
struct ListedPrimitives {
    uint32_t after = 0; // this node's list that sets the attributes which the primitives leave behind; 0: none
    uint32_t modes = 0; // bit 1 << mode for each mode
    uint64_t vertices = 0;
    std::array<float, 4> lowest{}, highest{};
};

// The last command for one attribute.
struct ListedAttribute {
    uint16_t opcode = 0;
    std::array<uint32_t, 2> selectors{}; // an index, or a face and a parameter
    std::vector<std::byte> arguments;
};

// The native list in compilation.
class ListSection {
public:
    void take(uint16_t opcode, std::span<const std::byte> arguments);

    // Whether the list has nothing but bounded primitives and their attributes.
    [[nodiscard]] bool isPlain() const;
    [[nodiscard]] const ListedPrimitives& primitives() const { return primitives_; }
    // Attributes that the list sets before its first primitive, and in primitives, in the order of their last commands.
    [[nodiscard]] const std::vector<ListedAttribute>& attributesBefore() const { return before_; }
    [[nodiscard]] const std::vector<ListedAttribute>& attributesInside() const { return inside_; }

private:
    void addPosition(uint16_t opcode, std::span<const std::byte> arguments);
    void addAttribute(uint16_t opcode, std::span<const std::byte> arguments);

    ListedPrimitives primitives_;
    std::vector<ListedAttribute> before_, inside_;
    uint32_t groupsBefore_ = 0, groupsInside_ = 0; // of these attributes: bits
    uint32_t begins_ = 0;
    bool isInPrimitive_ = false;
    bool isForeign_ = false; // has other commands
};

} // namespace mural::replay
