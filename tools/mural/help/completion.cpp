#include "tools/mural/help/completion.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/mural/help/value_kinds.hpp"

namespace mural::cli {

namespace {

using Words = std::vector<std::string>;

const OptionFacts* optionNamed(const CommandFacts& command, const std::string& name) {
    for (const OptionFacts& option : command.options)
        if (!option.isPositional && std::ranges::find(option.names, name) != option.names.end()) return &option;
    return nullptr;
}

const OptionFacts* positionalAt(const CommandFacts& command, size_t index) {
    const OptionFacts* last = nullptr;
    for (const OptionFacts& option : command.options) {
        if (!option.isPositional) continue;
        if (index == 0) return &option;
        index -= 1;
        last = &option;
    }
    // The words of `mural ctl` are values of one argument.
    const auto kind = last != nullptr ? valueKindOf(command.name, *last) : std::nullopt;
    return kind && kind->source == ValueSource::ControlWords ? last : nullptr;
}

// The meaning of the words before the last one.
struct Position {
    const OptionFacts* valueOf = nullptr; // the last word is the value of this option
    bool isValueOptional = false;
    std::optional<size_t> program; // index of the first word of a program
    Words given;                   // options, by their longest names
    Words arguments;               // positional ones
    std::string config;            // value of --config, or of the argument FILE of `mural config`
};

Position positionOf(const CommandFacts& command, const Words& words) {
    Position at;
    const size_t last = words.size() - 1;
    for (size_t i = 2; i < last; ++i) {
        const std::string& word = words[i];
        if (word == "--" && command.takesProgram) {
            at.program = i + 1;
            return at;
        }
        if (word.size() > 1 && word.front() == '-') {
            const size_t equals = word.find('=');
            const OptionFacts* option = optionNamed(command, word.substr(0, equals));
            if (option == nullptr) continue;
            const std::string& name = at.given.emplace_back(option->names.back());
            if (equals != std::string::npos) {
                if (name == "--config") at.config = word.substr(equals + 1);
                continue;
            }
            // A flag has no value; "--verify=N" has one only after '='.
            const bool takesWord = !option->value.empty() && (!option->isValueOptional || option->value.front() == '[');
            if (!takesWord) continue;
            if (i + 1 == last) {
                at.valueOf = option;
                at.isValueOptional = option->isValueOptional;
                return at;
            }
            if (option->isValueOptional && words[i + 1].starts_with("-")) continue;
            i += 1;
            if (name == "--config") at.config = words[i];
            continue;
        }
        if (command.startsProgram) {
            at.program = i;
            return at;
        }
        const OptionFacts* positional = positionalAt(command, at.arguments.size());
        if (positional != nullptr && positional->names.front() == "FILE") at.config = word;
        at.arguments.push_back(word);
    }
    return at;
}

class Completer {
public:
    Completer(const std::vector<CommandFacts>& commands, const Words& words, LiveValues& live)
        : commands_(commands), words_(words), live_(live), word_(words.back()) {}

    Completion complete() {
        if (words_.size() == 2 && !word_.starts_with("-")) {
            offerCommands();
            return std::move(completion_);
        }
        const CommandFacts* command = words_.size() == 2 ? &commands_.front() : commandNamed(commands_, words_[1]);
        if (command == nullptr || words_[1].empty()) return std::move(completion_);
        const Position at = positionOf(*command, words_);
        if (at.program) {
            completion_.part = ShellPart::Program;
            completion_.programWord = *at.program;
        } else if (at.valueOf != nullptr && !(at.isValueOptional && word_.starts_with("-"))) {
            offerValue(*command, *at.valueOf, at);
        } else if (const size_t equals = word_.find('='); word_.starts_with("--") && equals != std::string::npos) {
            completion_.prefix = word_.substr(0, equals + 1);
            if (const OptionFacts* option = optionNamed(*command, word_.substr(0, equals)); option != nullptr)
                offerValue(*command, *option, at);
        } else if (word_.starts_with("-")) {
            offerOptions(*command, at);
        } else if (const OptionFacts* argument = positionalAt(*command, at.arguments.size()); argument != nullptr) {
            offerValue(*command, *argument, at);
        } else if (command->startsProgram) {
            completion_.part = ShellPart::Program;
            completion_.programWord = words_.size() - 1;
        } else {
            offerOptions(*command, at);
        }
        return std::move(completion_);
    }

private:
    void offer(const std::string& word, const std::string& meaning) {
        const std::string whole = completion_.prefix + word;
        if (whole.starts_with(word_)) completion_.candidates.push_back({whole, meaning});
    }
    void offerAll(const std::vector<Candidate>& candidates) {
        for (const Candidate& candidate : candidates) offer(candidate.word, candidate.meaning);
    }

    void offerCommands() {
        for (const CommandFacts& command : commands_)
            if (!command.name.empty() && !command.isHidden) offer(command.name, command.meaning);
    }

    void offerOptions(const CommandFacts& command, const Position& at) {
        for (const OptionFacts& option : command.options) {
            if (option.isPositional || std::ranges::find(at.given, option.names.back()) != at.given.end()) continue;
            for (const std::string& name : option.names) offer(name, option.meaning);
        }
    }

    void offerValue(const CommandFacts& command, const OptionFacts& option, const Position& at) {
        const auto kind = valueKindOf(command.name, option);
        if (!kind) {
            completion_.part = ShellPart::Undescribed;
            return;
        }
        for (const std::string& word : kind->words) offer(word, {});
        switch (kind->source) {
        case ValueSource::Words:
        case ValueSource::Number:
        case ValueSource::Text: break;
        case ValueSource::File:
            completion_.part = ShellPart::Files;
            completion_.pattern = kind->pattern;
            break;
        case ValueSource::Folder: completion_.part = ShellPart::Folders; break;
        case ValueSource::Hosts: offerHosts(); break;
        case ValueSource::Command: completion_.part = ShellPart::Command; break;
        case ValueSource::Interface: offerAll(live_.interfaces()); break;
        case ValueSource::Session: offerAll(live_.sessions()); break;
        case ValueSource::ControlWords: offerControlWords(at.arguments); break;
        case ValueSource::Layout: offerAll(live_.layouts(at.config)); break;
        case ValueSource::Canvas: offerAll(live_.canvases(at.config)); break;
        case ValueSource::MuralCommand: offerCommands(); break;
        }
    }

    // A list: completes the name after the last comma.
    void offerHosts() {
        const size_t comma = word_.rfind(',');
        if (comma != std::string::npos) completion_.prefix = word_.substr(0, comma + 1);
        if (word_.substr(completion_.prefix.size()).starts_with("@"))
            offerAll(live_.daemons());
        else
            completion_.part = ShellPart::Hosts;
    }

    void offerControlWords(const Words& words) {
        bool takesFile = false;
        if (words.empty()) offerAll(live_.sessions());
        offerAll(live_.controlWords(words, takesFile));
        if (takesFile) completion_.part = ShellPart::Files;
    }

    const std::vector<CommandFacts>& commands_;
    const Words& words_;
    LiveValues& live_;
    std::string word_;
    Completion completion_;
};

} // namespace

Completion completionOf(const std::vector<CommandFacts>& commands, const std::vector<std::string>& words,
                        LiveValues& live) {
    if (words.size() < 2 || commands.empty()) return {};
    return Completer(commands, words, live).complete();
}

} // namespace mural::cli
