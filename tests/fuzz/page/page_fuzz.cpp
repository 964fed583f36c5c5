// Feeds arbitrary bytes to the parser of browsers' messages, and random operations to the rules about roles, links and
// topics. No message of a viewer passes a check that its role fails.
#include <string>
#include <string_view>

#include "common/json/json_text.hpp"
#include "nodes/input/keyboard_map.hpp"
#include "nodes/input/pointer_place.hpp"
#include "nodes/input/program_display.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tools/mural/page/access/link_table.hpp"
#include "tools/mural/page/access/request_origin.hpp"
#include "tools/mural/page/access/role.hpp"
#include "tools/mural/page/hub/topic_fan.hpp"
#include "tools/mural/page/protocol/client_message.hpp"

namespace mural::fuzz {
namespace {

using page::ClientMessage;
using page::Role;

uint64_t examine(const input::InputEvent& event) {
    must(event.x >= 0 && event.x <= 1 && event.y >= 0 && event.y <= 1, "places are fractions");
    must(event.button >= 1 && event.button <= 9, "buttons are 1 to 9");
    const int pixel = input::pixelAt(event.x, 1920);
    must(pixel >= 0 && pixel < 1920, "pixels are in the window");
    double rest = 0;
    must(input::wheelSteps(rest, event.wheelY).size() <= 20, "steps are bounded");
    return input::keysymOfKey(event.key, event.code) + input::codePointsOf(event.text).size();
}

uint64_t examine(const page::RequestMessage& request) {
    const bool isReading = page::requiredRole(request.operation, request.arguments) == Role::View;
    must(!isReading || request.operation != "stop", "stop requires a role");
    page::TopicFan fan;
    uint64_t count = isReading ? 1 : 0;
    if (request.arguments.is_object()) {
        if (fan.subscribe(1, request.arguments, 0)) ++count;
        if (fan.unsubscribe(1, request.arguments)) ++count;
    }
    if (page::linkTermsOf(request.arguments)) ++count;
    return count;
}

uint64_t examine(const page::HelloMessage& hello) {
    static const page::LinkTable links;
    must(!links.find(hello.token, 0).has_value(), "no token is valid without a link");
    must(hello.name.size() <= 64, "names are bounded");
    return 1;
}

template <class Other> uint64_t examine(const Other&) { return 0; }

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    const std::string_view bytes(reinterpret_cast<const char*>(input.data()), input.size());
    const ClientMessage message = page::parseClientMessage(bytes);
    uint64_t successes = std::visit([](const auto& kind) { return examine(kind); }, message);
    static const page::KnownHosts hosts({"localhost"});
    const bool isKnown = hosts.isKnownHost(bytes);
    must(!isKnown || page::hostName(bytes) == "localhost", "one host is known");
    if (hosts.isOwnOrigin(bytes, bytes)) ++successes;
    return successes + input::cookieIn(bytes).size() + input::variableIn(bytes, "DISPLAY").size();
}

} // namespace mural::fuzz
