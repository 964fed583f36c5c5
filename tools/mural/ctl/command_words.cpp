#include "tools/mural/ctl/command_words.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>

#include "common/json/json_text.hpp"
#include "nodes/head/control/control_operations.hpp"
#include "tools/mural/ctl/control_client.hpp"

namespace mural::cli {

namespace {

using Json = nlohmann::json;

// One word of an operation's usage.
struct UsageWord {
    std::string word; // argument names in lower case
    bool isArgument = false;
    bool isOptional = false;
};

std::vector<UsageWord> usageWords(const std::string& usage) {
    std::vector<UsageWord> words;
    std::istringstream text(usage);
    for (std::string word; text >> word;) {
        UsageWord& entry = words.emplace_back();
        entry.isOptional = word.size() > 2 && word.front() == '[' && word.back() == ']';
        if (entry.isOptional) word = word.substr(1, word.size() - 2);
        entry.isArgument = std::isupper(static_cast<unsigned char>(word.front())) != 0;
        std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        entry.word = word;
    }
    return words;
}

// Returns the name of the argument, in the spelling of the operation.
const Json* argumentOf(const Json& operation, const std::string& lowerName) {
    const auto list = operation.find("arguments");
    if (list == operation.end() || !list->is_array()) return nullptr;
    for (const Json& argument : *list) {
        std::string name = textOf(argument, "name");
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (!name.empty() && name == lowerName) return &argument;
    }
    return nullptr;
}

std::optional<int64_t> wholeOf(const std::string& word) {
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

Result<Json> valueOf(const std::string& word, const Json& argument) {
    const std::string kind = textOf(argument, "kind"), name = textOf(argument, "name");
    if (kind == "whole number") {
        if (const auto whole = wholeOf(word)) return Json(*whole);
        return Error{name + " must be a whole number instead of " + word};
    }
    if (kind == "truth value") {
        if (word == "on" || word == "true" || word == "yes") return Json(true);
        if (word == "off" || word == "false" || word == "no") return Json(false);
        return Error{name + " must be on or off instead of " + word};
    }
    if (kind == "file") { // the session has another current folder
        std::error_code failed;
        const auto path = std::filesystem::absolute(word, failed);
        if (word.empty() || failed) return Error{name + " must be a file instead of \"" + word + "\""};
        return Json(path.lexically_normal().string());
    }
    if (kind == "object") {
        Json object = parseJson(word);
        if (object.is_object()) return object;
        return Error{name + " must be an object of JSON instead of " + word};
    }
    return Json(word);
}

// True if the fixed words at the beginning of the usage are the same.
bool beginsAlike(const std::vector<UsageWord>& usage, const std::vector<std::string>& words) {
    for (size_t i = 0; i < usage.size(); ++i) {
        if (usage[i].isArgument || usage[i].isOptional) continue;
        if (i >= words.size() || words[i] != usage[i].word) return false;
    }
    return !usage.empty();
}

Result<CommandRequest> filled(const Json& operation, const std::vector<UsageWord>& usage,
                              const std::vector<std::string>& words) {
    CommandRequest request{textOf(operation, "name")};
    const std::string hint = "; usage: mural ctl " + textOf(operation, "usage");
    size_t at = 0;
    for (const UsageWord& wanted : usage) {
        if (at >= words.size() && wanted.isOptional) continue;
        if (at >= words.size()) return Error{"the argument " + wanted.word + " is missing" + hint};
        const std::string& word = words[at];
        const bool isOther = !wanted.isArgument && word != wanted.word;
        if (isOther && wanted.isOptional) continue;
        if (isOther) return Error{"unexpected word " + word + hint};
        ++at;
        if (!wanted.isArgument && !wanted.isOptional) continue;
        const Json* const argument = argumentOf(operation, wanted.word);
        if (argument == nullptr) return Error{"the session describes no argument " + wanted.word + hint};
        auto value = wanted.isArgument ? valueOf(word, *argument) : Result<Json>(Json(true)); // "[force]"
        if (!value) return Error{value.error().message + hint};
        request.arguments[textOf(*argument, "name")] = std::move(*value);
    }
    if (at < words.size()) return Error{"unexpected word " + words[at] + hint};
    return request;
}

Error unknown(const std::vector<std::string>& words, const Json& operations) {
    std::vector<std::string> names, usages;
    for (const Json& operation : operations) {
        if (!operation.is_object()) continue;
        const std::string usage = textOf(operation, "usage");
        const std::string first = usage.substr(0, usage.find(' '));
        if (first == words.front()) usages.push_back(usage);
        if (std::ranges::find(names, first) == names.end()) names.push_back(first);
    }
    if (usages.empty()) return Error{unknownOperation(words.front(), names).text};
    std::string all;
    for (const std::string& usage : usages) all += (all.empty() ? "" : ", or mural ctl ") + usage;
    return Error{words.front() + " has other words; usage: mural ctl " + all};
}

} // namespace

bool namesSession(const std::string& word) {
    static const std::regex kName("[0-9]+|mural-[0-9]+-[0-9a-f]{16}|/.*");
    return std::regex_match(word, kName);
}

std::vector<NextWord> nextWords(const std::vector<std::string>& words, const Json& operations) {
    std::vector<NextWord> found;
    if (!operations.is_array()) return found;
    for (const Json& operation : operations) {
        const std::vector<UsageWord> usage = usageWords(textOf(operation, "usage"));
        if (words.size() >= usage.size()) continue;
        const bool fits = std::ranges::all_of(words, [&, i = size_t{0}](const std::string& word) mutable {
            const UsageWord& wanted = usage[i++];
            return wanted.isArgument || word == wanted.word;
        });
        if (!fits) continue;
        const UsageWord& next = usage[words.size()];
        const Json* const argument = next.isArgument ? argumentOf(operation, next.word) : nullptr;
        NextWord entry{next.word, argument != nullptr ? textOf(*argument, "kind") : "", textOf(operation, "name"),
                       textOf(operation, "meaning")};
        const bool isKnown = std::ranges::any_of(
            found, [&](const NextWord& other) { return other.word == entry.word && entry.kind.empty(); });
        if (!isKnown) found.push_back(std::move(entry));
    }
    return found;
}

Result<CommandRequest> requestOf(const std::vector<std::string>& words, const Json& operations) {
    if (words.empty()) return Error{"a command is required, such as status; help lists all"};
    if (operations.is_array()) {
        for (const Json& operation : operations) {
            if (!operation.is_object()) continue;
            const std::vector<UsageWord> usage = usageWords(textOf(operation, "usage"));
            if (beginsAlike(usage, words)) return filled(operation, usage, words);
        }
    }
    return unknown(words, operations);
}

} // namespace mural::cli
