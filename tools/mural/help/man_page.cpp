#include "tools/mural/help/man_page.hpp"

#include <cctype>
#include <sstream>

#include <fmt/format.h>

namespace mural::cli {

namespace {

// Returns text with the characters escaped that roff would interpret or replace.
std::string escaped(const std::string& text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool beginsLine = i == 0 || text[i - 1] == '\n';
        if (beginsLine && (c == '.' || c == '\'')) out += "\\&"; // a request of roff
        if (text.compare(i, 3, "\xe2\x80\xa6") == 0) {           // U+2026, which not every output device has
            out += "...";
            i += 2;
            continue;
        }
        switch (c) {
        case '\\': out += "\\(rs"; break;
        case '-': out += "\\-"; break;
        case '\'': out += "\\(aq"; break;
        case '`': out += "\\(ga"; break;
        case '^': out += "\\(ha"; break;
        case '~': out += "\\(ti"; break;
        default: out += c;
        }
    }
    return out;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string asSentence(std::string text) {
    if (text.empty()) return text;
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    if (text.back() != '.') text += '.';
    return text;
}

// The footer of --help consists of paragraphs. "Examples:" and "Exit status:" begin sections of the page.
struct Footer {
    std::string examples, exitStatus, notes;
};

Footer dividedFooter(const std::string& text) {
    Footer footer;
    std::string* section = &footer.notes;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line == "Example:" || line == "Examples:") {
            section = &footer.examples;
            continue;
        }
        if (line.starts_with("Exit status:")) {
            section = &footer.exitStatus;
            line = line.substr(line.size() > 12 ? 13 : 12);
        } else if (section == &footer.examples && !line.empty() && line.front() != ' ') {
            section = &footer.notes;
        } else if (line.empty() && section == &footer.exitStatus) {
            section = &footer.notes; // a blank line ends the list of statuses
        }
        // "Exit status:" may follow other sentences of its line.
        const size_t within = section == &footer.notes ? line.find("Exit status:") : std::string::npos;
        if (within != std::string::npos) {
            footer.notes += line.substr(0, within) + "\n";
            line = line.substr(within + 13);
            section = &footer.exitStatus;
        }
        *section += line + "\n";
    }
    return footer;
}

std::string trimmed(const std::string& text) {
    const size_t begin = text.find_first_not_of('\n');
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of("\n ") + 1 - begin);
}

// Keeps indented lines as they are, and fills the others.
std::string paragraphs(const std::string& text) {
    std::string out;
    bool isKept = false;
    std::istringstream lines(trimmed(text));
    for (std::string line; std::getline(lines, line);) {
        const bool indented = line.starts_with("  ");
        if (indented != isKept) out += indented ? ".PP\n.nf\n" : ".fi\n.PP\n";
        isKept = indented;
        out += line.empty() ? ".PP\n" : escaped(line) + "\n";
    }
    return isKept ? out + ".fi\n" : out;
}

std::string section(const std::string& title, const std::string& body) {
    return body.empty() ? std::string() : ".SH " + title + "\n" + body;
}

std::string optionEntry(const OptionFacts& option) {
    std::string heading;
    for (const std::string& name : option.names) {
        heading += (heading.empty() ? "" : ", ") + (option.isPositional ? italic(name) : bold(name));
    }
    if (!option.value.empty() && !option.isPositional) {
        if (!option.isValueOptional)
            heading += " " + italic(option.value);
        else if (option.value.front() == '[') // "[H1,H2]" is a word of its own
            heading += " " + italic(option.value);
        else
            heading += "[=" + italic(option.value) + "]";
    }
    std::string text = escaped(asSentence(option.meaning));
    if (!option.choices.empty()) {
        std::string names;
        for (const std::string& choice : option.choices) names += (names.empty() ? "" : ", ") + bold(choice);
        text += "\nValues: " + names + ".";
    }
    if (!option.limits.empty()) text += "\nLimits: " + escaped(option.limits) + ".";
    for (const std::string& needed : option.needs) text += "\nRequires " + bold(needed) + ".";
    if (option.isRequired) text += "\nRequired.";
    return ".TP\n" + heading + "\n" + text + "\n";
}

std::string optionList(const CommandFacts& command, bool positional) {
    std::string list;
    for (const OptionFacts& option : command.options)
        if (option.isPositional == positional) list += optionEntry(option);
    return list;
}

std::string heading(const std::string& name, const std::string& version, const std::string& date) {
    std::string title = name;
    for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return fmt::format(".\\\" Made by mural help --man from the definitions of the command line.\n"
                       ".TH {} 1 \"{}\" \"mural {}\" \"Mural\"\n",
                       escaped(title), escaped(date), escaped(version));
}

std::string commandList(const std::vector<CommandFacts>& all) {
    std::string list;
    for (const CommandFacts& command : all) {
        if (command.name.empty() || command.isHidden) continue;
        list += ".TP\n" + bold(manPageName(command)) + "(1)\n" + escaped(asSentence(command.meaning)) + "\n";
    }
    return list;
}

std::string seeAlso(const CommandFacts& command, const std::vector<CommandFacts>& all) {
    std::string list;
    for (const CommandFacts& other : all) {
        if (other.isHidden || other.name == command.name) continue;
        list += (list.empty() ? "" : ",\n") + std::string(".BR ") + escaped(manPageName(other)) + " (1)";
    }
    // ".BR name (1)," keeps the comma on the line of the macro.
    std::string joined;
    std::istringstream lines(list);
    for (std::string line; std::getline(lines, line);) joined += line + "\n";
    return joined;
}

} // namespace

std::string manPageName(const CommandFacts& command) {
    return command.name.empty() ? std::string("mural") : "mural-" + command.name;
}

std::string manPage(const CommandFacts& command, const std::vector<CommandFacts>& all, const std::string& version,
                    const std::string& date) {
    const bool isMural = command.name.empty();
    const Footer footer = dividedFooter(command.footer);
    const std::string meaning = isMural ? command.meaning.substr(command.meaning.find(": ") + 2) : command.meaning;
    std::string name = meaning;
    while (!name.empty() && name.back() == '.') name.pop_back();
    const size_t words = command.usage.find(' ', isMural ? 0 : 6);
    const std::string rest = words == std::string::npos ? "" : command.usage.substr(words);
    std::string page = heading(manPageName(command), version, date);
    page += section("NAME", escaped(manPageName(command)) + " \\- " + escaped(name) + "\n");
    page += section("SYNOPSIS", bold(command.usage.substr(0, words)) + escaped(rest) + "\n");
    page += section("DESCRIPTION", escaped(asSentence(meaning)) + "\n" +
                                       (trimmed(footer.notes).empty() ? "" : ".PP\n" + paragraphs(footer.notes)));
    if (isMural) page += section("COMMANDS", commandList(all));
    page += section("ARGUMENTS", optionList(command, true));
    page += section("OPTIONS", optionList(command, false));
    page += section("EXAMPLES",
                    trimmed(footer.examples).empty() ? "" : ".nf\n" + escaped(trimmed(footer.examples)) + "\n.fi\n");
    page += section("EXIT STATUS", paragraphs(footer.exitStatus));
    page += section("SEE ALSO", seeAlso(command, all));
    return page;
}

} // namespace mural::cli
