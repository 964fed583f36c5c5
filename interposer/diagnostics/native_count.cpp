#include "interposer/diagnostics/native_count.hpp"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

#include "common/base/clock.hpp"
#include "interposer/encode/frame_cpu.hpp"
#include "interposer/process/launch_settings.hpp"
#include "interposer/diagnostics/log.hpp"

namespace mural {

namespace {

int64_t firstNs = 0;
long frames = 0;
uint64_t cpuNs = 0; // of the threads that show frames
long cpuFrames = 0; // number of frames in cpuNs

void writeReport(const char* path, int64_t nowNs) {
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (fd < 0) return;
    char line[128];
    const int n = snprintf(line, sizeof line, "%ld %.6f %.6f %ld\n", frames, static_cast<double>(nowNs - firstNs) / 1e9,
                           static_cast<double>(cpuNs) / 1e9, cpuFrames);
    writeAll(fd, line, static_cast<size_t>(n));
    close(fd);
}

} // namespace

bool nativeRun() { return launchSettings().native != nullptr; }

void countNativeFrame() {
    const int64_t nowNs = monotonicNowNs();
    if (firstNs == 0) firstNs = nowNs; // the time of the first frame is start-up
    ++frames;
    static thread_local constinit FrameCpu cpu __attribute__((tls_model("initial-exec")));
    if (const uint64_t tookNs = cpu.afterFrame()) {
        cpuNs += tookNs;
        cpuFrames += FrameCpu::kFrames;
    }
    const char* const path = launchSettings().nativeReport;
    const char* const limit = launchSettings().nativeFrames;
    const long last = limit ? atol(limit) : 0;
    static int64_t writtenNs = 0;
    if (path && (frames == last || nowNs - writtenNs > kNsPerS / 20)) {
        writtenNs = nowNs;
        writeReport(path, nowNs);
    }
}

} // namespace mural
