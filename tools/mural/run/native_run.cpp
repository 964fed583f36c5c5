// `mural run --native`: the capture library only counts frames and writes the count into a file.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <sys/mman.h>
#include <unistd.h>

#include "nodes/launch/program_check.hpp"
#include "tools/mural/run/program_loop.hpp"

namespace mural::cli {

namespace {

// Descendants may outlive the program. The run waits for them while they swap.
constexpr int64_t kNoPictureMs = 5'000;

// The file that the capture library rewrites: in memory, named through /proc.
class NativeReport {
public:
    NativeReport() : fd_(memfd_create("mural-native-report", MFD_CLOEXEC)) {}
    NativeReport(const NativeReport&) = delete;
    NativeReport& operator=(const NativeReport&) = delete;
    ~NativeReport() { close(fd_); }

    [[nodiscard]] bool ok() const { return fd_ >= 0; }
    [[nodiscard]] std::string path() const {
        return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd_);
    }

    struct Count {
        int64_t frames = 0;
        double seconds = 0;
        double cpuSeconds = 0;
        int64_t cpuFrames = 0;
    };
    // Returns the last complete line.
    [[nodiscard]] std::optional<Count> read() const {
        char text[4096];
        const off_t size = lseek(fd_, 0, SEEK_END);
        const off_t maximum = sizeof text - 1;
        const ssize_t n = pread(fd_, text, sizeof text - 1, size > maximum ? size - maximum : 0);
        if (n <= 0) return {};
        text[n] = '\0';
        std::optional<Count> last;
        for (const char* line = text; line != nullptr;) {
            const char* end = std::strchr(line, '\n');
            Count count;
            long long frames = 0, cpuFrames = 0;
            if (end != nullptr &&
                std::sscanf(line, "%lld %lf %lf %lld", &frames, &count.seconds, &count.cpuSeconds, &cpuFrames) == 4) {
                count.frames = frames;
                count.cpuFrames = cpuFrames;
                last = count;
            }
            line = end != nullptr ? end + 1 : nullptr;
        }
        return last;
    }

private:
    int fd_;
};

void printCount(const std::optional<NativeReport::Count>& count, const PreparedRun& run, Console& console) {
    if (!count || count->frames == 0) {
        console.error("no frame was counted: " + run.program.front() +
                      " showed no picture through GL; check that it is an OpenGL program");
        return;
    }
    // n pictures have n - 1 intervals.
    const double rate = count->seconds > 0 ? static_cast<double>(count->frames - 1) / count->seconds : 0.0;
    console.say(fmt::format("native: {} frames in {:.1f} s, {:.1f} frames/s", count->frames, count->seconds, rate));
    writeReport(
        run,
        fmt::format(
            R"({{"event":"report","native":true,"frames":{},"seconds":{:.6f},"framesPerSecond":{:.3f},"frameCpuSeconds":{:.6f},"frameCpuFrames":{}}})",
            count->frames, count->seconds, rate, count->cpuSeconds, count->cpuFrames),
        console);
}

// Returns true when the requested number of frames is reached.
bool countFrames(PreparedRun& run, launch::ProgramSupervisor& program, const NativeReport& report, Console& console) {
    bool reached = false;
    int64_t frames = 0;
    Deadline patience = Deadline::inMs(kNoPictureMs);
    while (program.programRunning() || (program.anyoneLeft() && !program.stopRequested() && !patience.passed())) {
        waitTurn(run, program, -1);
        const auto count = report.read();
        if (program.programRunning() || (count && count->frames != frames)) patience = Deadline::inMs(kNoPictureMs);
        if (!count) continue;
        frames = count->frames;
        if (run.config.frames > 0 && frames >= run.config.frames && !reached) {
            reached = true;
            program.end(kEndGraceMs);
        }
        console.progress(frames, count->seconds > 0 ? static_cast<double>(frames) / count->seconds : 0, 0);
    }
    return reached;
}

} // namespace

int runNative(PreparedRun& run, Console& console) {
    auto supervisor = launch::ProgramSupervisor::create();
    const NativeReport report;
    if (!supervisor || !report.ok()) {
        console.error(supervisor ? "no memory for the frame counter: " + std::string(std::strerror(errno))
                                 : supervisor.error().message);
        return launch::kExitUsage;
    }
    launch::ProgramSupervisor& program = *supervisor.value();
    if (run.display) program.leaveAlone(run.display->pid());
    launch::Environment& environment = run.programEnvironment;
    environment.unset("MURAL_SESSION");
    environment.set("MURAL_NATIVE", "1");
    environment.set("MURAL_NATIVE_REPORT", report.path());
    if (run.config.frames > 0) environment.set("MURAL_NATIVE_FRAMES", std::to_string(run.config.frames));
    if (!startProgram(run, program, console)) return launch::kExitNotExecutable;

    const bool framesReached = countFrames(run, program, report, console);
    printCount(report.read(), run, console);
    return framesReached ? 0 : program.exitStatus();
}

} // namespace mural::cli
