#include "tools/mural/hosts/fix_script.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "nodes/launch/launchers/shell_words.hpp"

namespace mural::cli {

namespace {

struct AdvisedCommand {
    std::string text;
    bool isHere = false; // on this machine, not on the host
};

bool startsWithAny(const std::string& text, std::initializer_list<const char*> beginnings) {
    return std::ranges::any_of(beginnings, [&](const char* b) { return text.starts_with(b); });
}

// Advice has commands between backticks; "here" follows those for this machine, and "or" precedes alternatives.
std::vector<AdvisedCommand> commandsIn(const std::string& advice) {
    std::vector<AdvisedCommand> commands;
    size_t at = 0;
    while ((at = advice.find('`', at)) != std::string::npos) {
        const size_t end = advice.find('`', at + 1);
        if (end == std::string::npos) break;
        AdvisedCommand command{advice.substr(at + 1, end - at - 1)};
        command.isHere = advice.compare(end + 1, 5, " here") == 0 || command.text.starts_with("ssh-copy-id ");
        const bool isAlternative = at >= 3 && advice.compare(at - 3, 3, "or ") == 0;
        if (!isAlternative) commands.push_back(std::move(command));
        at = end + 1;
    }
    return commands;
}

// "NAME" stands for a word of the reader.
bool hasBlank(const std::string& command) {
    const std::vector<std::string> words = launch::wordsOf(command);
    return std::ranges::any_of(words, [](const std::string& word) {
        return word.size() > 1 && std::ranges::all_of(word, [](unsigned char c) { return std::isupper(c) != 0; });
    });
}

// Some examine only, and some have no effect in another shell, or require a decision.
bool isForTheReader(const std::string& command) {
    return startsWithAny(command, {"nft list ", "ethtool", "du ", "getent ", "ping ", "ssh ", "ssh-keyscan ", "mural ",
                                   "xrandr", "xhost ", "ulimit "});
}

// Texts of hosts must not begin a line of the script.
std::string onOneLine(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return text;
}

std::string linesOf(const std::string& host, const std::string& finding, const std::string& advice,
                    const std::string& launchCommand) {
    std::string text = fmt::format("\n# {}: {}\n#   {}\n", onOneLine(host), onOneLine(finding), onOneLine(advice));
    for (const AdvisedCommand& command : commandsIn(advice)) {
        if (isForTheReader(command.text) || hasBlank(command.text)) continue;
        text += command.isHere
                    ? command.text + "\n"
                    : fmt::format("{} {} {}\n", launchCommand, launch::quoted(host), launch::quoted(command.text));
    }
    return text;
}

} // namespace

std::string fixScriptOf(const std::vector<HostChecks>& hosts, const std::string& launchCommand) {
    std::string text =
        "#!/bin/sh\n# Commands for the findings of mural doctor. Read them before you run them: most need "
        "root rights.\n";
    for (const Health health : {Health::Bad, Health::Warn})
        for (const HostChecks& h : hosts)
            for (const Check& c : h.checks)
                if (c.health == health) text += linesOf(h.host, c.name + ": " + c.found, c.advice, launchCommand);
    return text;
}

} // namespace mural::cli
