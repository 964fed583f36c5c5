#include "tools/mural/run/native_program.hpp"

#include <algorithm>

#include "nodes/launch/elf_check.hpp"

namespace mural::cli {

namespace {

constexpr std::string_view kLibrary = "libmural.so";

Result<void> checkOptions(const RunOptions& options, const SessionConfig& c) {
    if (options.native)
        return Error{"--native runs a program with its own GL, which a program with the native API lacks"};
    if (c.verifyEvery > 0)
        return Error{"--verify compares with the program's own GL, which a program with the native API lacks; compare "
                     "the pictures of two runs with --out instead"};
    if (!c.record.empty())
        return Error{
            "--record writes streams of GL commands, which a program with the native API does not send; omit it"};
    if (c.glBackend == "osmesa")
        return Error{
            "--gl osmesa: a program with the native API may call a linked GL library, which has no contexts of "
            "OSMesa; use egl or glx"};
    if (options.displayChosen && c.display == Display::App)
        return Error{"--display app shows the wall in the program's own window, which a program with the native API "
                     "lacks; use --display windows"};
    const auto isDaemon = [](const std::string& host) { return host.starts_with("@"); };
    if (std::ranges::any_of(c.hosts, isDaemon) || std::ranges::any_of(c.spareHosts, isDaemon))
        return Error{"waiting nodes (@name) start mural only; reach the hosts of a program with the native API by ssh"};
    return {};
}

} // namespace

bool usesNativeApi(const launch::ProgramCheck& program) {
    auto library = launch::readLibrary(program.path);
    if (!library) return false;
    return std::ranges::any_of(library->needed, [](const std::string& name) { return name.starts_with(kLibrary); });
}

Result<void> prepareNativeProgram(const RunOptions& options, const launch::ProgramCheck& program, PreparedRun& run) {
    SessionConfig& c = run.config;
    if (auto checked = checkOptions(options, c); !checked) return checked;
    if (c.nodeProgram.empty()) {
        c.nodeProgram = program.path;
    } else {
        const auto found =
            launch::findProgram(c.nodeProgram, run.programEnvironment.get("PATH").value_or("/usr/bin:/bin"));
        if (!found.ok()) return Error{"--node-program: " + found.message};
        c.nodeProgram = found.path;
    }
    // Screens of a room have the perspective of the room. There is no other program's view to keep.
    if (!c.configFile.empty() && c.projection == ProjectionChoice::Auto) c.projection = ProjectionChoice::Room;
    run.programEnvironment.set("MURAL_SESSION", c.session);
    return {};
}

} // namespace mural::cli
