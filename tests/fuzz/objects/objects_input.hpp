// The object type of the fuzz target, and the division of its input into messages: each has a length of two bytes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <mural/archive.hpp>

namespace mural::fuzz {

struct FuzzedNode {
    int32_t value = 0;
    std::vector<FuzzedNode> children;
    template <class Visit> void fields(Visit& visit) { visit(value, children); }
};

struct FuzzedObject {
    double angle = 0;
    std::string title;
    std::vector<float> heights;
    std::vector<std::string> names;
    std::map<int16_t, bool> flags;
    std::variant<std::monostate, Range, std::string> choice;
    std::optional<PixelViewport> area;
    FuzzedNode tree;
    Blob mesh;
    Ref<FuzzedNode> other;
    template <class Visit> void fields(Visit& visit) {
        visit(angle, title, heights, names, flags, choice, area, tree, mesh, other);
    }
};

// Cuts the next message from the input; empty at its end.
inline std::span<const std::byte> nextMessage(std::span<const std::byte>& input) {
    if (input.size() < 2) return {};
    const size_t length = std::to_integer<size_t>(input[0]) | std::to_integer<size_t>(input[1]) << 8;
    input = input.subspan(2);
    const auto message = input.first(std::min(length, input.size()));
    input = input.subspan(message.size());
    return message;
}

} // namespace mural::fuzz
