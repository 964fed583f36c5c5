// What `mural run` tells its user, on standard error: lines, one line of progress, the final report.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/clock.hpp"
#include "tools/mural/head_events.hpp"

namespace mural::cli {

class Console {
public:
    explicit Console(bool quiet);
    // A line that matters also to those who want quiet.
    void error(const std::string& text);
    void say(const std::string& text);
    // On a terminal one line that is written anew; elsewhere a line now and then.
    void progress(int64_t frame, double framesPerSecond, double bytesPerFrame);

private:
    void write(const std::string& text);
    bool quiet_;
    bool terminal_;
    bool progressShown_ = false;
    Deadline nextLine_;
};

// The report's lines, in words.
std::vector<std::string> reportLines(const SessionReport& report);

// "glReadPixels 3, glGetQueryObjectuiv 2", the most frequent first; of counts by command.
std::string roundTripText(const std::map<std::string, int64_t>& countsBy);

// "812 B", "12.3 kB", "4.56 MB": powers of ten.
std::string sizeText(double sizeBytes);

} // namespace mural::cli
