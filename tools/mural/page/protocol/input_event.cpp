#include "tools/mural/page/protocol/input_event.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace mural::page {

namespace {

using Json = nlohmann::json;
using input::InputEvent;
using input::InputKind;

constexpr std::array<std::string_view, 8> kInputKinds = {"move", "down", "up", "wheel", "key", "text", "touch", "blur"};
constexpr size_t kMaxKeyBytes = 64;
constexpr double kMaxWheel = 120 * 100;
constexpr int kMaxButton = 9;

bool readFraction(const Json& value, double& into) {
    if (!value.is_number()) return false;
    into = value.get<double>();
    return std::isfinite(into) && into >= 0 && into <= 1;
}

bool readWheel(const Json& value, double& into) {
    if (!value.is_number()) return false;
    into = value.get<double>();
    return std::isfinite(into) && std::abs(into) <= kMaxWheel;
}

bool readText(const Json& value, size_t most, std::string& into) {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > most) return false;
    into = value.get<std::string>();
    return true;
}

bool readMember(std::string_view name, const Json& value, InputEvent& event) {
    if (name == "seq") {
        if (!value.is_number_unsigned() || value.get<uint64_t>() > UINT32_MAX) return false;
        event.number = value.get<uint32_t>();
        return true;
    }
    if (name == "kind") {
        if (!value.is_string()) return false;
        const auto found = std::ranges::find(kInputKinds, value.get_ref<const std::string&>());
        event.kind = static_cast<InputKind>(found - kInputKinds.begin());
        return found != kInputKinds.end();
    }
    if (name == "x") return readFraction(value, event.x);
    if (name == "y") return readFraction(value, event.y);
    if (name == "of") {
        event.isOfDisplay = value == "desktop";
        return event.isOfDisplay || value == "wall";
    }
    if (name == "button") {
        if (!value.is_number_unsigned() || value.get<uint64_t>() < 1 || value.get<uint64_t>() > kMaxButton)
            return false;
        event.button = value.get<int>();
        return true;
    }
    if (name == "dx") return readWheel(value, event.wheelX);
    if (name == "dy") return readWheel(value, event.wheelY);
    if (name == "key") return readText(value, kMaxKeyBytes, event.key);
    if (name == "code") return readText(value, kMaxKeyBytes, event.code);
    if (name == "text") return readText(value, size_t{64} << 10, event.text);
    if (name == "down") {
        if (!value.is_boolean()) return false;
        event.isDown = value.get<bool>();
        return true;
    }
    return false;
}

} // namespace

std::optional<InputEvent> inputEventOf(const Json& message) {
    if (!message.is_object() || !message.contains("seq") || !message.contains("kind")) return std::nullopt;
    InputEvent event;
    for (const auto& [name, value] : message.items())
        if (!readMember(name, value, event)) return std::nullopt;
    event.hasPlace = message.contains("x") && message.contains("y");
    const bool needsPlace = event.kind == InputKind::Move || event.kind == InputKind::Down ||
                            event.kind == InputKind::Up || (event.kind == InputKind::Touch && event.isDown);
    if (needsPlace && !event.hasPlace) return std::nullopt;
    if (event.kind == InputKind::Key && (event.key.empty() || !message.contains("down"))) return std::nullopt;
    return event;
}

} // namespace mural::page
