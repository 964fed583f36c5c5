// The messages between a head and a daemon on their secure channel: one byte for the type, then the payload.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mural {

enum class NodeMessageKind : uint8_t {
    Command = 0, // to the daemon: run mural with these zero-terminated arguments
    Input = 1,   // data for standard input
    InputEnd = 2,
    Output = 3,  // to the head: data of standard output
    Errors = 4,  // data of standard error
    Ended = 5,   // exit status (a byte), then a description
    Refused = 6, // the reason; then the channel closes
};

struct NodeMessage {
    NodeMessageKind kind{};
    std::vector<std::byte> body;
};

constexpr size_t kMaxCommandBytes = 8192;
constexpr size_t kMaxCommandArguments = 32;
constexpr size_t kMaxNodeMessageBytes = 65'536;

std::vector<std::byte> encode(const NodeMessage& message);
std::optional<NodeMessage> decodeNodeMessage(std::span<const std::byte> bytes);

NodeMessage commandMessage(const std::vector<std::string>& arguments);
// Returns nothing for an invalid command: limits exceeded, or no terminating zero.
std::optional<std::vector<std::string>> commandArguments(const NodeMessage& message);
NodeMessage textMessage(NodeMessageKind kind, const std::string& text);
std::string textOf(std::span<const std::byte> bytes);

} // namespace mural
