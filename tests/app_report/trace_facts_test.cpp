// Names of contexts, and traces that cannot be read.
#include <gtest/gtest.h>

#include "tools/mural/app_report/runs/trace_facts.hpp"

namespace mural::cli {
namespace {

TEST(AppReportTrace, namesContextsAsTheProgramRequestsThem) {
    EXPECT_EQ(contextName(0, 1, 0, 0), "OpenGL, any version");
    EXPECT_EQ(contextName(0, 3, 3, 1), "OpenGL 3.3 core");
    EXPECT_EQ(contextName(0, 4, 5, 2), "OpenGL 4.5 compatibility");
    EXPECT_EQ(contextName(0, 3, 1, 0), "OpenGL 3.1");
    EXPECT_EQ(contextName(1, 1, 0, 0), "OpenGL ES 1");
    EXPECT_EQ(contextName(2, 3, 1, 0), "OpenGL ES 3.1");
    EXPECT_EQ(contextName(2, 0, 0, 0), "OpenGL ES 2.0");
}

TEST(AppReportTrace, reportsAMissingTrace) {
    const TraceFacts facts = readTraceFacts("/nonexistent/app.mural");
    EXPECT_FALSE(facts.complete);
    EXPECT_FALSE(facts.problem.empty());
    EXPECT_EQ(facts.frames, 0);
}

} // namespace
} // namespace mural::cli
