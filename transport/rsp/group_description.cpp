#include "transport/rsp/group_description.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>

#include "transport/rsp/group_text.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural::rsp {

namespace {

using Set = Result<void> (*)(GroupOptions&, const std::string&);

Result<int64_t> numberOf(const std::string& text, int64_t maximum) {
    int64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || value < 0 || value > maximum)
        return Error{"\"" + text + "\" must be a whole number from 0 to " + std::to_string(maximum)};
    return value;
}

// Parses one of two words.
Result<void> choose(const std::string& text, const char* yes, const char* no, bool& into) {
    if (text != yes && text != no) return Error{"\"" + text + "\" must be " + yes + " or " + no};
    into = text == yes;
    return {};
}

template <class From, class Into> Result<void> put(Result<From> value, Into& into) {
    if (!value) return value.error();
    into = static_cast<Into>(*value);
    return {};
}

constexpr int64_t kMaxMs = 3'600'000;
constexpr int64_t kMaxDatagramBytesOption = 65'000;
constexpr int64_t kMaxWindowDatagrams = 65'536;

const std::array<std::pair<const char*, Set>, 15> kParameters{{
    {"control", [](GroupOptions& o, const std::string& v) -> Result<void> { return o.control = v, Result<void>(); }},
    {"datagram",
     [](GroupOptions& o, const std::string& v) { return put(numberOf(v, kMaxDatagramBytesOption), o.datagramBytes); }},
    {"interface",
     [](GroupOptions& o, const std::string& v) -> Result<void> { return o.interface = v, Result<void>(); }},
    {"multicast", [](GroupOptions& o, const std::string& v) { return choose(v, "on", "off", o.multicast); }},
    {"name", [](GroupOptions& o, const std::string& v) -> Result<void> { return o.name = v, Result<void>(); }},
    {"parity", [](GroupOptions& o, const std::string& v) { return choose(v, "on", "off", o.parity); }},
    {"probe-ms", [](GroupOptions& o, const std::string& v) { return put(numberOf(v, kMaxMs), o.probeMs); }},
    {"rate", [](GroupOptions& o, const std::string& v) { return put(parseRate(v), o.bytesPerS); }},
    {"seal", [](GroupOptions& o, const std::string& v) { return put(parseSeal(v), o.seal); }},
    {"secret", [](GroupOptions& o, const std::string& v) { return put(readSecret(v), o.secret); }},
    {"silent-ms", [](GroupOptions& o, const std::string& v) { return put(numberOf(v, kMaxMs), o.silentMs); }},
    {"socket", [](GroupOptions& o, const std::string& v) { return put(parseSize(v), o.socketBytes); }},
    {"stalled",
     [](GroupOptions& o, const std::string& v) -> Result<void> {
         bool eject = true;
         if (auto r = choose(v, "eject", "wait", eject); !r) return r;
         o.stalled = eject ? StallPolicy::Eject : StallPolicy::Wait;
         return {};
     }},
    {"stalled-ms", [](GroupOptions& o, const std::string& v) { return put(numberOf(v, kMaxMs), o.stalledMs); }},
    {"window",
     [](GroupOptions& o, const std::string& v) { return put(numberOf(v, kMaxWindowDatagrams), o.windowDatagrams); }},
}};

std::string allNames() {
    std::string names;
    for (const auto& [name, set] : kParameters) names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

} // namespace

Result<GroupOptions> groupOptionsOf(const ConnectionDescription& description) {
    GroupOptions options;
    options.group = endpointText(description.host, description.port);
    options.seal = bestEncryption(); // default
    const auto wrong = [&](const std::string& what) {
        return Error{"connection \"" + toText(description) + "\": " + what};
    };
    auto group = numericEndpoint(options.group);
    if (!group) return wrong(group.error().message);
    if (!group->isMulticast())
        return wrong(description.host + " is not a multicast address (224.0.0.0 to 239.255.255.255, or ff00:: and up)");
    for (const auto& [name, value] : description.parameters) {
        const auto found = std::ranges::find(kParameters, name, [](const auto& p) { return std::string(p.first); });
        if (found == kParameters.end()) return wrong("unknown parameter \"" + name + "\"; use " + allNames());
        if (auto set = found->second(options, value); !set) return wrong(name + ": " + set.error().message);
    }
    if (options.windowDatagrams < 64 || (options.windowDatagrams & (options.windowDatagrams - 1)) != 0)
        return wrong("window: must be a power of two from 64 to 65536");
    return options;
}

} // namespace mural::rsp
