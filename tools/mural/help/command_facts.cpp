#include "tools/mural/help/command_facts.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace mural::cli {

namespace {

// Returns the descriptions of the checks of a value, in order.
std::vector<std::string> checksOf(CLI::Option& option) {
    std::vector<std::string> found;
    try {
        for (int i = 0;; ++i) found.push_back(option.get_validator(i)->get_description());
    } catch (const CLI::OptionNotFound&) { // CLI11 has no count of validators
    }
    return found;
}

// "{auto,on,off}" of CLI::IsMember.
std::vector<std::string> membersOf(const std::string& check) {
    std::vector<std::string> members;
    if (check.size() < 3 || check.front() != '{' || check.back() != '}') return members;
    for (size_t at = 1; at < check.size();) {
        const size_t end = std::min(check.find(',', at), check.size() - 1);
        members.push_back(check.substr(at, end - at));
        at = end + 1;
    }
    return members;
}

// "FLOAT in [0.1 - 600]" of CLI::Range.
std::string limitsOf(const std::string& check) {
    const size_t begin = check.find(" in ["), middle = check.find(" - ");
    if (begin == std::string::npos || middle == std::string::npos || check.back() != ']') return {};
    return check.substr(begin + 5, middle - begin - 5) + " to " + check.substr(middle + 3, check.size() - middle - 4);
}

// CLI11 appends the checks to the name of the value: "SECONDS:FLOAT in [0.1 - 600]".
std::string valueName(CLI::Option& option, const std::vector<std::string>& checks) {
    std::string name = option.get_type_name(), suffix;
    for (const std::string& check : checks)
        if (!check.empty()) suffix += ":" + check;
    if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
    return name;
}

OptionFacts optionFacts(CLI::Option& option) {
    OptionFacts facts;
    facts.isPositional = option.get_positional();
    if (facts.isPositional) facts.names.push_back(option.get_name(true, false));
    for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
    facts.meaning = option.get_description();
    facts.isRequired = option.get_required();
    for (const CLI::Option* needed : option.get_needs()) facts.needs.push_back(needed->get_name());
    std::ranges::sort(facts.needs);
    if (!option.get_fnames().empty()) { // a flag with an optional value
        facts.value = "N";
        facts.isValueOptional = true;
        return facts;
    }
    if (option.get_expected_max() == 0) return facts; // a flag
    const std::vector<std::string> checks = checksOf(option);
    facts.value = facts.isPositional ? facts.names.front() : valueName(option, checks);
    facts.isValueOptional = option.get_expected_min() == 0;
    for (const std::string& check : checks) {
        if (facts.choices.empty()) facts.choices = membersOf(check);
        if (facts.limits.empty()) facts.limits = limitsOf(check);
    }
    return facts;
}

std::string usageOf(const CLI::App& app) {
    const auto* formatter = dynamic_cast<const CLI::Formatter*>(app.get_formatter().get());
    std::string line = formatter == nullptr ? app.get_name() : formatter->make_usage(&app, app.get_name());
    if (line.starts_with("Usage: ")) line = line.substr(7);
    while (!line.empty() && line.back() == '\n') line.pop_back();
    return line;
}

CommandFacts commandFacts(CLI::App& app) {
    CommandFacts facts;
    if (app.get_parent() != nullptr) facts.name = app.get_name();
    facts.meaning = app.get_description();
    facts.usage = usageOf(app);
    facts.footer = app.get_footer();
    facts.takesProgram = facts.usage.find("PROGRAM") != std::string::npos;
    facts.startsProgram = facts.takesProgram && app.get_prefix_command();
    facts.isHidden = app.get_parent() != nullptr && app.get_group().empty();
    for (CLI::Option* option : app.get_options(std::function<bool(CLI::Option*)>()))
        facts.options.push_back(optionFacts(*option));
    return facts;
}

} // namespace

std::vector<CommandFacts> factsOf(CLI::App& mural) {
    std::vector<CommandFacts> all{commandFacts(mural)};
    for (CLI::App* command : mural.get_subcommands([](CLI::App*) { return true; }))
        all.push_back(commandFacts(*command));
    return all;
}

const CommandFacts* commandNamed(const std::vector<CommandFacts>& commands, const std::string& name) {
    const auto found = std::ranges::find(commands, name, &CommandFacts::name);
    return found == commands.end() ? nullptr : &*found;
}

} // namespace mural::cli
