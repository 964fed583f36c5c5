// The command line of `mural show` as a value.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "nodes/output/windows/wall_sink.hpp"
#include "nodes/remote_wall/wall_receiver.hpp"

namespace CLI {
class App;
}

namespace mural::cli {

// Raw texts of the command line.
struct ShowArguments {
    std::string listen, secretFile, size, config, display, position, name;
    std::vector<std::string> outs;
    bool isFullScreen = false;
    int rate = 0; // 0: not given
};

struct ShowOptions {
    remote::WallReceiverConfig receiver;
    std::vector<std::string> outs;
    bool hasWindows = false;
    WallWindowsConfig windows;
    WallSink::Arrange arrange; // of the windows
};

void describeShow(CLI::App& command, ShowArguments& arguments);
// Returns one error, for the first invalid argument. Reads the secret and the configuration file.
Result<ShowOptions> showOptionsFrom(const ShowArguments& arguments);

extern const char* const kShowFooter;

} // namespace mural::cli
