#include "nodes/launch/launchers/host_list.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include "nodes/launch/launchers/shell_words.hpp"

namespace mural::launch {
namespace {

std::optional<uint64_t> numberOf(std::string_view text) {
    uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

std::string padded(uint64_t number, size_t width) {
    std::string digits = std::to_string(number);
    return digits.size() < width ? std::string(width - digits.size(), '0') + digits : digits;
}

// Splits at commas outside of brackets.
std::vector<std::string_view> partsOf(std::string_view text) {
    std::vector<std::string_view> parts;
    size_t begin = 0;
    int depth = 0;
    for (size_t i = 0; i <= text.size(); ++i) {
        const char c = i < text.size() ? text[i] : ',';
        depth += c == '[' ? 1 : c == ']' ? -1 : 0;
        if (c != ',' || (depth > 0 && i < text.size())) continue;
        parts.push_back(text.substr(begin, i - begin));
        begin = i + 1;
    }
    return parts;
}

// Expands the contents of brackets: "1-3,07".
Result<std::vector<std::string>> rangesOf(std::string_view text) {
    std::vector<std::string> numbers;
    for (const std::string_view part : partsOf(text)) {
        const size_t dash = part.find('-');
        const std::string_view low = part.substr(0, dash);
        const std::string_view high = dash == std::string_view::npos ? low : part.substr(dash + 1);
        const auto first = numberOf(low), last = numberOf(high);
        if (!first || !last || *last < *first || *last - *first >= kMaxHosts)
            return Error{"\"" + std::string(part) + "\" is no range of numbers"};
        for (uint64_t i = 0; i <= *last - *first; ++i) numbers.push_back(padded(*first + i, low.size()));
    }
    return numbers;
}

// Appends all hosts of one part, such as r[1-2]n[1-4].
Result<void> expandPart(std::string_view part, const std::string& prefix, std::vector<std::string>& hosts) {
    const size_t open = part.find('[');
    if (open == std::string_view::npos) {
        if (part.find(']') != std::string_view::npos) return Error{"a ] without its ["};
        hosts.push_back(prefix + std::string(part));
        return hosts.size() <= kMaxHosts ? Result<void>() : Error{"more than " + std::to_string(kMaxHosts) + " hosts"};
    }
    const size_t close = part.find(']', open);
    if (close == std::string_view::npos) return Error{"a [ without its ]"};
    const auto numbers = rangesOf(part.substr(open + 1, close - open - 1));
    if (!numbers) return numbers.error();
    for (const std::string& number : numbers.value()) {
        const auto expanded =
            expandPart(part.substr(close + 1), prefix + std::string(part.substr(0, open)) + number, hosts);
        if (!expanded) return expanded;
    }
    return {};
}

// Splits HOST:N. An IPv6 address with several colons has no number.
void takeCount(HostEntry& host) {
    const size_t colon = host.name.find(':');
    if (colon == std::string::npos || host.name.find(':', colon + 1) != std::string::npos) return;
    const auto number = numberOf(std::string_view(host.name).substr(colon + 1));
    if (!number || *number == 0 || *number > kMaxHosts) return;
    host.nodes = static_cast<int>(*number);
    host.name.erase(colon);
}

} // namespace

Result<std::vector<std::string>> expandHostList(std::string_view text) {
    std::vector<std::string> hosts;
    for (const std::string_view part : partsOf(text)) {
        const auto expanded = part.empty() ? Result<void>(Error{"an empty name"}) : expandPart(part, "", hosts);
        if (!expanded) return Error{"host list \"" + std::string(text) + "\": " + expanded.error().message};
    }
    return hosts;
}

bool isHostName(std::string_view word) {
    return !word.empty() && word.front() != '-' &&
           word.find_first_of(" \t\"'=,;&|<>$`\\(){}") == std::string_view::npos;
}

Result<std::vector<HostEntry>> hostsOfFile(std::string_view text, const std::string& file) {
    std::vector<HostEntry> hosts;
    size_t number = 0;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        std::string line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        line.erase(std::min(line.find('#'), line.size()));
        const std::vector<std::string> words = wordsOf(line);
        if (words.empty()) continue;
        const auto bad = [&](const std::string& why) {
            return Error{file + ":" + std::to_string(number) + ": " + why};
        };
        HostEntry host{words.front()};
        takeCount(host);
        if (!isHostName(host.name)) return bad("\"" + words.front() + "\" is no host name");
        for (size_t i = 1; i < words.size(); ++i) {
            const std::string& word = words[i];
            if (word.starts_with("max_slots=") || word.starts_with("max-slots=")) continue; // of Open MPI
            const auto slots = word.starts_with("slots=") ? numberOf(std::string_view(word).substr(6)) : std::nullopt;
            if (!slots || *slots == 0 || *slots > kMaxHosts)
                return bad("\"" + word + "\" is not slots=N, the number of nodes on the host");
            host.nodes = static_cast<int>(*slots);
        }
        hosts.push_back(host);
        if (hosts.size() > kMaxHosts) return bad("more than " + std::to_string(kMaxHosts) + " hosts");
    }
    if (hosts.empty()) return Error{file + ": it contains no host; give one per line"};
    return hosts;
}

} // namespace mural::launch
