#include "nodes/head/control/control_operations.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "nodes/head/control/nearest_names.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;
using Kind = ControlArgument::Kind;

constexpr size_t kMaxShownBytes = 60; // of a client's text in an error

std::string nameOf(Kind kind) {
    switch (kind) {
    case Kind::Whole: return "whole number";
    case Kind::Text: return "text";
    case Kind::Truth: return "truth value";
    case Kind::File: return "file";
    case Kind::Object: return "object";
    case Kind::Scalar: break;
    }
    return "text, number or truth value";
}

bool fits(Kind kind, const Json& value) {
    switch (kind) {
    case Kind::Whole:
        return value.is_number_integer() && !(value.is_number_unsigned() && value.get<uint64_t>() > INT64_MAX);
    case Kind::Text:
    case Kind::File: return value.is_string();
    case Kind::Truth: return value.is_boolean();
    case Kind::Object: return value.is_object();
    case Kind::Scalar: break;
    }
    return value.is_string() || value.is_number() || value.is_boolean();
}

std::string shown(const std::string& text) {
    return '"' + (text.size() > kMaxShownBytes ? text.substr(0, kMaxShownBytes) + "…" : text) + '"';
}

ControlError badArgument(const ControlOperation& operation, const std::string& text) {
    return {control_code::kBadArgument, operation.name + ": " + text + "; usage: " + operation.usage};
}

ControlError check(const ControlOperation& operation, const Json& arguments) {
    if (!arguments.is_object()) return badArgument(operation, "the arguments are not an object");
    for (const auto& [name, value] : arguments.items()) {
        const auto wanted = std::ranges::find(operation.arguments, name, &ControlArgument::name);
        if (wanted == operation.arguments.end())
            return badArgument(operation, "no argument has the name " + shown(name));
        if (!fits(wanted->kind, value)) return badArgument(operation, name + " is not a " + nameOf(wanted->kind));
    }
    for (const ControlArgument& argument : operation.arguments)
        if (argument.isRequired && !arguments.contains(argument.name))
            return badArgument(operation, "the argument " + argument.name + " is missing");
    return {};
}

std::string usageOf(const ControlOperation& operation) {
    std::string usage = operation.name;
    for (const ControlArgument& argument : operation.arguments) {
        std::string word = argument.name;
        const bool isFlag = argument.kind == Kind::Truth && !argument.isRequired;
        if (!isFlag)
            std::ranges::transform(word, word.begin(),
                                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        usage += argument.isRequired ? " " + word : " [" + word + "]";
    }
    return usage;
}

} // namespace

void ControlOperations::add(ControlOperation operation) {
    if (operation.usage.empty()) operation.usage = usageOf(operation);
    std::string name = operation.name;
    byName_.insert_or_assign(std::move(name), std::move(operation));
}

std::vector<std::string> ControlOperations::names() const {
    std::vector<std::string> names;
    for (const auto& [name, operation] : byName_) names.push_back(name);
    return names;
}

ControlError ControlOperations::perform(const std::string& name, const Json& arguments, Json& result) const {
    const auto found = byName_.find(name);
    if (found == byName_.end()) return unknownOperation(name, names());
    if (ControlError error = check(found->second, arguments); !error.code.empty()) return error;
    auto performed = found->second.perform(arguments);
    if (!performed) return {control_code::kFailed, performed.error().message};
    result = std::move(performed.value());
    return {};
}

void ControlOperations::describe(Json& list) const {
    for (const auto& [name, operation] : byName_) {
        Json arguments = Json::array();
        for (const ControlArgument& a : operation.arguments)
            arguments.push_back(
                {{"name", a.name}, {"kind", nameOf(a.kind)}, {"required", a.isRequired}, {"meaning", a.meaning}});
        list.push_back({{"name", name},
                        {"usage", operation.usage},
                        {"meaning", operation.meaning},
                        {"arguments", std::move(arguments)}});
    }
}

ControlError unknownOperation(const std::string& name, const std::vector<std::string>& names) {
    const std::vector<std::string> nearest = nearestNames(name, names);
    return {control_code::kUnknownOperation, "no operation has the name " + shown(name) +
                                                 (nearest.empty() ? "" : "; similar names: " + joinNames(nearest)) +
                                                 "; help lists all"};
}

} // namespace mural
