// Prints the output of `mural run` for the user on standard error: messages, one line of progress, and the final
// report.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "tools/mural/head_events.hpp"

namespace mural::cli {

class Console {
public:
    explicit Console(bool quiet);
    // Prints a line even with --quiet.
    void error(const std::string& text);
    void say(const std::string& text);
    // Shows the progress: on a terminal as one line that is overwritten, otherwise as an occasional line.
    void progress(int64_t frame, double framesPerSecond, double bytesPerFrame);

private:
    void write(const std::string& text);
    bool quiet_;
    bool terminal_;
    bool progressShown_ = false;
    Deadline nextLine_;
};

// Returns the report as lines of text.
std::vector<std::string> reportLines(const SessionReport& report);

// Returns the counts by command, most frequent first: "glReadPixels 3, glGetQueryObjectuiv 2".
std::string countsText(const std::map<std::string, int64_t>& countsBy);

// "812 B", "12.3 kB", "4.56 MB": powers of ten.
std::string sizeText(double sizeBytes);

} // namespace mural::cli
