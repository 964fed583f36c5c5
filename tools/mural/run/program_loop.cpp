#include "tools/mural/run/program_loop.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <poll.h>

namespace mural::cli {

void waitTurn(PreparedRun& run, launch::ProgramSupervisor& program, int extraFd) {
    pollfd waiting[3] = {{program.signalFd(), POLLIN, 0},
                         {extraFd, POLLIN, 0},
                         {run.windowManager ? run.windowManager->fd() : -1, POLLIN, 0}};
    poll(waiting, 3, kTurnMs); // poll ignores negative descriptors
    program.tick();
    // Without the display the program ends by itself, and the loop waits for that.
    if (run.windowManager && !run.windowManager->dispatch()) run.windowManager.reset();
}

void writeReport(const PreparedRun& run, const std::string& json, Console& console) {
    if (run.reportFile.empty()) return;
    std::ofstream file(run.reportFile, std::ios::trunc);
    file << json << '\n';
    file.close();
    if (!file) console.error("--report " + run.reportFile + ": cannot be written: " + std::strerror(errno));
}

bool startProgram(PreparedRun& run, launch::ProgramSupervisor& program, Console& console) {
    launch::SpawnRequest request;
    request.file = run.programPath;
    request.arguments = run.program;
    request.environment = run.programEnvironment.entries();
    const auto started = program.start(request);
    if (!started.ok()) console.error(started.error().message);
    return started.ok();
}

} // namespace mural::cli
