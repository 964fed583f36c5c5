#include "nodes/launch/bypass_watch.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>

#include "nodes/launch/base_name.hpp"
#include "nodes/launch/environment.hpp"
#include "nodes/launch/gl_libraries.hpp"

namespace mural::launch {

namespace {

constexpr size_t kMaxEnded = 256; // ended programs that the capture did not see; build tools and shells write no note

// Returns whether the library may draw. The other libraries of a program, about a hundred, are not opened.
bool mayDraw(std::string_view path) {
    for (const char* beginning : {"libGL", "libEGL", "libOSMesa", "libvulkan", "libX11.", "libxcb."}) {
        if (baseName(path).starts_with(beginning)) return true;
    }
    return false;
}

// Lists the files that are mapped for execution, from /proc/PID/maps.
UncapturedProgram runningProgram(pid_t pid) {
    UncapturedProgram found;
    char name[4096];
    const std::string folder = "/proc/" + std::to_string(pid);
    const ssize_t length = readlink((folder + "/exe").c_str(), name, sizeof name);
    if (length > 0) found.program.assign(name, static_cast<size_t>(length));
    std::ifstream maps(folder + "/maps");
    std::set<std::string> paths;
    for (std::string line; std::getline(maps, line);) {
        const auto path = line.find('/');
        if (path == std::string::npos || line.find(" r-xp ") == std::string::npos) continue;
        paths.insert(line.substr(path));
    }
    found.libraries.assign(paths.begin(), paths.end());
    return found;
}

struct Finding {
    Drawing drawing = Drawing::None;
    std::string program, path; // path: the library that draws
    bool glvnd = false;        // the program also has GLVND
};

// Returns the program's way of drawing outside GLVND. Of several, returns the most specific one.
Finding findingOf(const UncapturedProgram& program) {
    Finding found{Drawing::None, std::string(baseName(program.program)), {}};
    const auto rank = [](Drawing d) {
        return d == Drawing::OwnGl       ? 4
               : d == Drawing::OffScreen ? 3
               : d == Drawing::Vulkan    ? 2
               : d == Drawing::X11       ? 1
                                         : 0;
    };
    bool fronted = false;
    for (const std::string& path : program.libraries) fronted = fronted || baseName(path) == kPreloadLibraryName;
    for (const std::string& path : program.libraries) {
        const Drawing drawing = mayDraw(path) ? drawingOf(path) : Drawing::None;
        found.glvnd = found.glvnd || drawing == Drawing::Glvnd || (drawing == Drawing::OwnGl && fronted);
        if (drawing == Drawing::OwnGl && fronted) continue; // the preload library captures it
        if (rank(drawing) <= rank(found.drawing)) continue;
        found.drawing = drawing;
        found.path = path;
    }
    return found;
}

std::string describe(const Finding& f) {
    switch (f.drawing) {
    case Drawing::OwnGl:
        return f.program + " uses " + f.path +
               ", which GLVND does not load, so its GL calls bypass Mural and its own window shows the picture. Use "
               "--capture-via preload, or remove that library (LD_LIBRARY_PATH)";
    case Drawing::OffScreen:
        return f.program + " draws with OSMesa (" + f.path +
               ") into its own memory, which Mural cannot capture; its own window shows the picture. Use a build with "
               "GLX or EGL";
    case Drawing::Vulkan:
        return f.program + " seems to draw with Vulkan (" + f.path +
               "), which Mural does not support; its own window shows the picture. Select OpenGL in its options";
    case Drawing::X11:
        if (f.glvnd) return {};
        return f.program + " has a window but loads no GL library: it draws with X11, which Mural does not support. "
                           "Select OpenGL in its options";
    default: return {};
    }
}

} // namespace

std::string describeBypass(const std::vector<UncapturedProgram>& programs, bool failed) {
    Finding best;
    std::string line;
    for (const UncapturedProgram& program : programs) {
        const Finding found = findingOf(program);
        if (failed && found.drawing == Drawing::X11) continue;
        const std::string text = describe(found);
        // Prefers other programs to one that draws with X11 only, which may be the launcher's dialog.
        if (text.empty() || (!line.empty() && (found.drawing == Drawing::X11 || best.drawing == Drawing::OwnGl)))
            continue;
        best = found;
        line = text;
    }
    return line;
}

std::string describeUncaptured(const UncapturedProgram& program) {
    std::string gl;
    for (const std::string& path : program.libraries) {
        if (baseName(path) == kCaptureLibraryName) return {};
        const Drawing drawing = gl.empty() && mayDraw(path) ? drawingOf(path) : Drawing::None;
        if (drawing == Drawing::Glvnd || drawing == Drawing::OwnGl) gl = path;
    }
    if (gl.empty()) return {};
    return std::string(baseName(program.program)) + " uses GL (" + gl +
           ") without the capture library: its parent removed LD_PRELOAD from the environment, or a sandbox hides the "
           "library's folder. Its own window shows the picture";
}

Result<std::unique_ptr<BypassWatch>> BypassWatch::create() {
    const int fd = memfd_create("mural-notes", MFD_CLOEXEC);
    if (fd < 0) return Error{std::string("no memory for bypass notes of programs: ") + std::strerror(errno)};
    return std::unique_ptr<BypassWatch>(new BypassWatch(fd));
}

BypassWatch::~BypassWatch() { close(fd_); }

std::string BypassWatch::notesPath() const {
    return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd_);
}

// Notes are lines of fields between tabs: "say" and a text; "ended", the program and its libraries.
void BypassWatch::readNotes() {
    char part[16384];
    std::string text;
    for (ssize_t n = 0; (n = pread(fd_, part, sizeof part, static_cast<off_t>(read_ + text.size()))) > 0;)
        text.append(part, static_cast<size_t>(n));
    const auto whole = text.rfind('\n');
    if (whole == std::string::npos) return;
    read_ += whole + 1;
    for (size_t at = 0; at <= whole;) {
        const size_t end = text.find('\n', at);
        std::vector<std::string> fields;
        for (size_t from = at; from <= end;) {
            const size_t to = std::min(text.find('\t', from), end);
            fields.push_back(text.substr(from, to - from));
            from = to + 1;
        }
        at = end + 1;
        if (fields.size() == 2 && fields[0] == "say") {
            if (std::find(reported_.begin(), reported_.end(), fields[1]) != reported_.end()) continue;
            reported_.push_back(fields[1]);
            waiting_.push_back(fields[1]);
        } else if (fields.size() > 2 && fields[0] == "ended" && ended_.size() < kMaxEnded) {
            ended_.push_back({fields[1], {fields.begin() + 2, fields.end()}});
        }
    }
}

std::vector<std::string> BypassWatch::newLines() {
    readNotes();
    return std::exchange(waiting_, {});
}

std::string BypassWatch::describeUncaptured(const std::vector<pid_t>& processes) {
    for (const pid_t pid : processes) {
        const UncapturedProgram program = runningProgram(pid);
        if (uncapturedReported_.contains(program.program)) continue;
        if (std::string line = launch::describeUncaptured(program); !line.empty()) {
            uncapturedReported_.insert(program.program);
            return line;
        }
    }
    return {};
}

std::string BypassWatch::describeRunning(const std::vector<pid_t>& processes) const {
    std::vector<UncapturedProgram> programs;
    for (const pid_t pid : processes) programs.push_back(runningProgram(pid));
    return describeBypass(programs);
}

} // namespace mural::launch
