#include "tools/mural/page/protocol/client_message.hpp"

#include <algorithm>
#include <cmath>

#include "common/json/json_text.hpp"
#include "nodes/head/control/control_request.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;

constexpr size_t kMaxTokenBytes = 128, kMaxViewerNameBytes = 64;
constexpr int kMaxPixels = 1 << 15;
constexpr double kMaxTime = 1e15; // ms

ClientMessage invalid(std::string problem) { return InvalidMessage{nullptr, std::move(problem)}; }

// Cuts a text between two characters of UTF-8.
std::string shortened(const std::string& text, size_t most) {
    size_t end = std::min(text.size(), most);
    while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end);
}

ClientMessage helloOf(const Json& hello) {
    HelloMessage result;
    const auto token = hello.find("token");
    if (token == hello.end() || !token->is_string() || token->get_ref<const std::string&>().size() > kMaxTokenBytes)
        return invalid("hello requires a token");
    result.token = token->get<std::string>();
    if (const auto name = hello.find("name"); name != hello.end() && name->is_string())
        result.name = shortened(name->get<std::string>(), kMaxViewerNameBytes);
    if (const auto use = hello.find("canUse"); use != hello.end() && use->is_object()) {
        const auto h264 = use->find("h264");
        result.decodesH264 = h264 != use->end() && *h264 == true;
    }
    if (const auto px = hello.find("px"); px != hello.end() && px->is_array() && px->size() == 2) {
        const auto side = [](const Json& value) {
            return value.is_number_unsigned() && value.get<uint64_t>() <= kMaxPixels ? value.get<int>() : 0;
        };
        result.width = side((*px)[0]);
        result.height = side((*px)[1]);
    }
    return result;
}

ClientMessage ackOf(const Json& ack) {
    const auto frame = ack.find("frame");
    if (frame == ack.end() || !frame->is_number_unsigned()) return invalid("ack requires a frame");
    return AckMessage{frame->get<uint64_t>()};
}

// Returns the only member of a message that is no request; null: none.
const Json* memberAlone(const Json& message, const char* name) {
    if (!message.is_object() || message.size() != 1) return nullptr;
    const auto found = message.find(name);
    return found != message.end() ? &*found : nullptr;
}

} // namespace

ClientMessage parseClientMessage(std::string_view text) {
    if (text.size() > kMaxTextMessageBytes) return invalid("a message has 65536 bytes at most");
    ControlRequest request = parseControlRequest(text);
    if (request.problem.empty())
        return RequestMessage{std::move(request.id), std::move(request.operation), std::move(request.arguments)};
    const Json message = depthOfJson(text) > kMaxControlDepth ? Json() : parseJson(text);
    if (const Json* hello = memberAlone(message, "hello"); hello != nullptr && hello->is_object())
        return helloOf(*hello);
    if (const Json* input = memberAlone(message, "input"); input != nullptr) {
        if (auto event = inputEventOf(*input)) return *event;
        return invalid("invalid input event");
    }
    if (const Json* ack = memberAlone(message, "ack"); ack != nullptr && ack->is_object()) return ackOf(*ack);
    if (const Json* ping = memberAlone(message, "ping"); ping != nullptr && ping->is_number()) {
        const auto time = ping->get<double>();
        if (std::isfinite(time) && std::abs(time) < kMaxTime) return PingMessage{time};
    }
    return InvalidMessage{std::move(request.id), std::move(request.problem)};
}

} // namespace mural::page
