// What a head and a waiting node tell each other over their secure channel: a byte of kind, and its bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mural {

enum class NodeMessageKind : uint8_t {
    Order = 0,    // to the node: run Mural with these arguments, each with a zero behind it
    Input = 1,    // for its standard input
    InputEnd = 2,
    Output = 3,   // to the head: of its standard output
    Errors = 4,   // of its standard error
    Ended = 5,    // how, as text, behind the exit status (a byte)
    Refused = 6,  // why; then the channel ends
};

struct NodeMessage {
    NodeMessageKind kind{};
    std::vector<std::byte> body;
};

constexpr size_t kMostOrderBytes = 8192;
constexpr size_t kMostOrderArguments = 32;
constexpr size_t kMostNodeMessageBytes = 65'536;

std::vector<std::byte> encode(const NodeMessage& message);
std::optional<NodeMessage> decodeNodeMessage(std::span<const std::byte> bytes);

NodeMessage orderMessage(const std::vector<std::string>& arguments);
// Nothing for what is no order: bounds, or no zero at its end.
std::optional<std::vector<std::string>> orderArguments(const NodeMessage& message);
NodeMessage textMessage(NodeMessageKind kind, const std::string& text);
std::string textOf(std::span<const std::byte> bytes);

} // namespace mural
