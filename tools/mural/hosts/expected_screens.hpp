// The X displays and sizes that a configuration file expects of each host.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace mural::cli {

struct ExpectedWindow {
    std::string name;
    int x = 0, y = 0, width = 0, height = 0; // pixels on the screen of its display
    bool fullScreen = false;
};

struct ExpectedScreen {
    std::string display;                 // ":0.1"; empty: the one of the environment
    int width = 0, height = 0;           // of the X screen; 0: the file does not state it
    std::vector<ExpectedWindow> windows; // with a stated size
};

// By host, as the file spells it; empty: this machine. Errors: the file cannot be used.
Result<std::map<std::string, std::vector<ExpectedScreen>>> expectedScreens(const std::string& file);

} // namespace mural::cli
