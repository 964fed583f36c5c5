// Toolkits and interfaces by the names of libraries, and the processes of a run.
#include <gtest/gtest.h>
#include <unistd.h>

#include "tools/mural/app_report/runs/program_watch.hpp"

namespace mural::cli {
namespace {

TEST(AppReportWatch, recognizesToolkitsByTheirLibraries) {
    ProgramSeen seen;
    for (const char* name : {"libQt5Gui.so.5.15.8", "libSDL2-2.0.so.0", "libGLX.so.0.0.0", "libc.so.6", "libEGL.so.1"})
        noteLibrary(name, seen);
    EXPECT_EQ(seen.toolkits, (std::set<std::string>{"Qt 5", "SDL 2"}));
    EXPECT_EQ(seen.interfaces, (std::set<std::string>{"EGL", "GLX"}));
}

TEST(AppReportWatch, countsNoProcessesOfOtherParents) {
    ProgramWatch watch;
    watch.look(getpid()); // this test has no children
    EXPECT_EQ(watch.seen().processes, 0);
    EXPECT_TRUE(watch.seen().programs.empty());
}

} // namespace
} // namespace mural::cli
