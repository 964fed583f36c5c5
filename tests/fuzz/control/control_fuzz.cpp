// Feeds arbitrary bytes to the protocol of one control client, in two parts. Every line that it writes is one object of
// JSON, replies never outnumber lines, and memory stays bounded.
#include <algorithm>
#include <string>
#include <string_view>

#include "common/json/json_text.hpp"
#include "tests/control/sample_operations.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace mural::fuzz {
namespace {

// Performs all requests and returns the number of successful ones.
uint64_t drain(ControlProtocol& client, size_t& replies) {
    uint64_t successes = 0;
    while (client.hasRequest()) client.perform(8, 0);
    client.offer(ControlTopic::Log, R"({"text":"line"})");
    client.sendMessages(1);
    std::string text(client.unsent());
    client.sent(text.size());
    must(client.unsent().empty(), "sent bytes go");
    must(text.empty() || text.back() == '\n', "lines are complete");
    size_t at = 0;
    for (size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
        const auto line = parseJson(text.substr(at, end - at));
        must(line.is_object(), "a line is one object");
        if (line.contains("topic") || line.contains("hello")) continue;
        ++replies;
        must(line["ok"].is_boolean() && line["ok"] != line.contains("error"), "a failed reply has an error");
        successes += line["ok"] == true ? 1 : 0;
    }
    return successes;
}

} // namespace

uint64_t fuzzOne(std::span<const std::byte> input) {
    static const ControlOperations operations = sampleOperations();
    const std::string_view bytes(reinterpret_cast<const char*>(input.data()), input.size());
    ControlProtocol client(operations, nlohmann::json::object());
    size_t replies = 0;
    uint64_t successes = 0;
    const size_t half = bytes.size() / 2;
    for (const std::string_view part : {bytes.substr(0, half), bytes.substr(half)}) {
        if (client.acceptsBytes()) client.receive(part);
        successes += drain(client, replies);
    }
    must(replies <= static_cast<size_t>(std::ranges::count(bytes, '\n')) + 1, "a line has one reply at most");
    return successes;
}

} // namespace mural::fuzz
