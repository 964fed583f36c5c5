// The command line of an example program: options such as "--frames 5", and names of files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace mural::examples {

// Takes options one by one. The first problem is kept until finish().
class Arguments {
public:
    Arguments(int argc, char** argv) : words_(argv + (argc > 0 ? 1 : 0), argv + argc) {}

    // Whether the option is given.
    bool takeFlag(std::string_view name);
    // The word after the option, if the option is given.
    std::optional<std::string> takeText(std::string_view name);
    // The number after the option, or `otherwise`. A number outside of [lowest, highest] is a problem.
    double takeNumber(std::string_view name, double otherwise, double lowest, double highest);
    // Returns the remaining words. Errors: the first problem; an unknown option.
    Result<std::vector<std::string>> finish();

private:
    void fail(const std::string& problem);

    std::vector<std::string> words_;
    std::string problem_;
};

// Returns the components, from 0 to 1, of a colour such as "ff8000". Error: the text is none.
Result<std::array<float, 3>> parseColour(std::string_view text);

// Whether the command line asks for help: the only word is --help or -h.
[[nodiscard]] bool isHelpWanted(int argc, char** argv);

} // namespace mural::examples
