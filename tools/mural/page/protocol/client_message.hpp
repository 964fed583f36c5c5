// Text messages of a browser (docs/reference/page.md). Pure. Accepts any bytes.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "tools/mural/page/http/connection_site.hpp"
#include "tools/mural/page/protocol/input_event.hpp"

namespace mural::page {

struct HelloMessage {
    std::string token;
    std::string name;
    bool decodesH264 = false;
    int width = 0, height = 0; // pixels of the browser's window; 0: unknown
};

struct RequestMessage {
    nlohmann::json id;
    std::string operation;
    nlohmann::json arguments;
};

struct AckMessage {
    uint64_t frame = 0;
};

struct PingMessage {
    double time = 0; // the browser's clock in ms
};

struct InvalidMessage {
    nlohmann::json id; // of the request, if it has one
    std::string problem;
};

using ClientMessage =
    std::variant<InvalidMessage, HelloMessage, RequestMessage, input::InputEvent, AckMessage, PingMessage>;

[[nodiscard]] ClientMessage parseClientMessage(std::string_view text);

} // namespace mural::page
