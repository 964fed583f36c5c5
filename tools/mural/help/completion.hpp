// The words by which a shell can continue a command line of mural. Pure, except for LiveValues.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/mural/help/command_facts.hpp"

namespace mural::cli {

struct Candidate {
    std::string word;    // the whole word that replaces the last one
    std::string meaning; // one line; may be empty
};

// The part that the shell itself completes, after the candidates.
// Undescribed: value_kinds.cpp lacks the value, which a test rejects.
enum class ShellPart { None, Files, Folders, Hosts, Command, Program, Undescribed };

struct Completion {
    std::vector<Candidate> candidates;
    ShellPart part = ShellPart::None;
    std::string prefix;     // begin of the last word that the shell must keep, such as "--out=" or "wall1,"
    std::string pattern;    // of file names; empty: all
    size_t programWord = 0; // for Program: index of the program in the words
};

// Values that exist only while Mural is used. Every function has a deadline below one second.
class LiveValues {
public:
    virtual ~LiveValues() = default;
    virtual std::vector<Candidate> sessions() = 0;
    // The words that may follow in `mural ctl`; `takesFile`: a file name may follow.
    virtual std::vector<Candidate> controlWords(const std::vector<std::string>& words, bool& takesFile) = 0;
    virtual std::vector<Candidate> daemons() = 0; // "@NAME"
    virtual std::vector<Candidate> interfaces() = 0;
    // Of a configuration file; empty if it cannot be read.
    virtual std::vector<Candidate> layouts(const std::string& file) = 0;
    virtual std::vector<Candidate> canvases(const std::string& file) = 0;
};

// words: the command line up to the cursor, from "mural" on; the last word is completed and may be empty.
Completion completionOf(const std::vector<CommandFacts>& commands, const std::vector<std::string>& words,
                        LiveValues& live);

} // namespace mural::cli
