// `mural trim`: extracts frames of a trace.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace mural::cli {

struct TrimArguments {
    std::string file, frames, out;
};

void describeTrim(CLI::App& command, TrimArguments& arguments);
int trimCommand(const TrimArguments& arguments);

} // namespace mural::cli
