#include "nodes/daemon/node_message.hpp"

#include <algorithm>

#include "common/base/copy_bytes.hpp"

namespace mural {

std::vector<std::byte> encode(const NodeMessage& m) {
    std::vector<std::byte> bytes(1 + m.body.size());
    bytes.front() = static_cast<std::byte>(m.kind);
    copyBytes(m.body, std::span(bytes).subspan(1));
    return bytes;
}

std::optional<NodeMessage> decodeNodeMessage(std::span<const std::byte> bytes) {
    if (bytes.empty() || bytes.size() > 1 + kMaxNodeMessageBytes ||
        bytes[0] > std::byte{static_cast<uint8_t>(NodeMessageKind::Refused)})
        return {};
    return NodeMessage{static_cast<NodeMessageKind>(bytes[0]), {bytes.begin() + 1, bytes.end()}};
}

NodeMessage commandMessage(const std::vector<std::string>& arguments) {
    NodeMessage m{NodeMessageKind::Command, {}};
    for (const std::string& a : arguments) {
        const auto* at = reinterpret_cast<const std::byte*>(a.c_str());
        m.body.insert(m.body.end(), at, at + a.size() + 1);
    }
    return m;
}

std::optional<std::vector<std::string>> commandArguments(const NodeMessage& m) {
    if (m.kind != NodeMessageKind::Command || m.body.empty() || m.body.size() > kMaxCommandBytes ||
        m.body.back() != std::byte{0})
        return {};
    std::vector<std::string> arguments;
    for (auto at = m.body.begin(); at != m.body.end();) {
        const auto end = std::find(at, m.body.end(), std::byte{0});
        arguments.push_back(textOf({at, end}));
        at = end + 1;
    }
    if (arguments.size() > kMaxCommandArguments) return {};
    return arguments;
}

NodeMessage textMessage(NodeMessageKind kind, const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {kind, {bytes.begin(), bytes.end()}};
}

std::string textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace mural
