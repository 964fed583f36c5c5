#include "native/runtime/node_main.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <exception>
#include <string_view>

#include "native/runtime/native_player.hpp"
#include "nodes/render/node.hpp"

namespace mural::native {

namespace {

constexpr int kExitUsage = 2;

// Takes the options of `mural node`, which the head passes.
std::optional<NodeOptions> nodeOptionsOf(int argc, char** argv) {
    NodeOptions options;
    for (int i = 2; i + 1 < argc; i += 2) {
        const std::string_view name = argv[i], value = argv[i + 1];
        if (name == "--connect")
            options.connect = value;
        else if (name == "--as")
            options.name = value;
        else if (name != "--connect-fd" ||
                 std::from_chars(value.data(), value.data() + value.size(), options.connectFd).ec != std::errc())
            return std::nullopt;
    }
    const bool isComplete = (options.connectFd >= 0) != !options.connect.empty();
    return isComplete ? std::optional(options) : std::nullopt;
}

} // namespace

std::optional<int> runNodeIfRequested(int argc, char** argv, const Program& program) {
    if (argc < 2 || std::strcmp(argv[1], "--mural-node") != 0) return std::nullopt;
    const auto options = nodeOptionsOf(argc, argv);
    if (!options) {
        std::fprintf(stderr,
                     "%s: --mural-node starts a render node and is for the head of a session; start the program "
                     "with mural run -- %s\n",
                     argv[0], argv[0]);
        return kExitUsage;
    }
    return runNode(*options,
                   [&program](std::unique_ptr<gl::Platform> platform, const PlayerConfig& config,
                              PlayerOutputs outputs) -> Result<std::unique_ptr<StreamPlayer>> {
                       std::unique_ptr<Renderer> renderer;
                       try {
                           if (program.renderer) renderer = program.renderer();
                       } catch (const std::exception& e) {
                           return Error{std::string("the constructor of the Renderer has thrown: ") + e.what()};
                       }
                       if (!renderer) return Error{"the program makes no Renderer; set Program::renderer"};
                       return NativePlayer::open(std::move(platform), config, std::move(outputs), std::move(renderer));
                   });
}

} // namespace mural::native
