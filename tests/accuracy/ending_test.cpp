// A measurement that ends early: signals are recorded and their handlers restored, and result files without contents
// are removed.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/temporary_folder.hpp"
#include "tools/mural/child_runs/interruption.hpp"
#include "tools/mural/child_runs/result_file.hpp"

namespace mural::cli {
namespace {

std::string contentOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST(ResultFile, isWrittenCompletely) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.at("old")) << "much longer than what comes";
    for (const char* name : {"new", "old"}) {
        auto file = ResultFile::open("--json", folder.at(name));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_TRUE(file->write("measured\n"));
    }
    EXPECT_EQ(contentOf(folder.at("new")), "measured\n");
    EXPECT_EQ(contentOf(folder.at("old")), "measured\n");
}

TEST(ResultFile, leavesFilesUnchangedWhenNotWritten) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.at("old")) << "of last week";
    for (const char* name : {"new", "old"}) {
        auto opened = ResultFile::open("--json", folder.at(name));
        ASSERT_TRUE(opened) << opened.error().message;
        const ResultFile moved = std::move(*opened);
        EXPECT_TRUE(std::filesystem::exists(folder.at(name)));
    }
    EXPECT_FALSE(std::filesystem::exists(folder.at("new")));
    EXPECT_EQ(contentOf(folder.at("old")), "of last week");
}

TEST(ResultFile, failsAtOnceWhenNotWritable) {
    const test::TemporaryFolder folder;
    const auto lost = ResultFile::open("--svg", folder.at("none/a.svg"));
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().message, "--svg " + folder.at("none/a.svg") +
                                        " cannot be written: No such file or directory; choose another file");
    EXPECT_FALSE(ResultFile::open("--svg", folder.at("")));
}

TEST(ResultFile, acceptsADeviceOrNoPath) {
    for (const char* path : {"/dev/null", ""}) {
        auto file = ResultFile::open("--json", path);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_TRUE(file->write("measured\n"));
    }
    EXPECT_TRUE(std::filesystem::exists("/dev/null"));
}

void (*handlerOf(int number))(int) {
    struct sigaction now {};
    sigaction(number, nullptr, &now);
    return now.sa_handler;
}

TEST(Interruption, recordsSignalsAndRestoresHandlers) {
    const auto before = handlerOf(SIGTERM);
    {
        const Interruption interruption;
        EXPECT_EQ(Interruption::signal(), 0);
        std::raise(SIGTERM);
        std::raise(SIGPIPE);
        EXPECT_EQ(Interruption::signal(), SIGTERM) << "the first counts";
    }
    EXPECT_EQ(handlerOf(SIGTERM), before);
    const Interruption another;
    EXPECT_EQ(Interruption::signal(), 0);
}

TEST(Interruption, leavesIgnoredSignalsAlone) {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    {
        const Interruption interruption;
        std::raise(SIGHUP);
        EXPECT_EQ(Interruption::signal(), 0);
    }
    EXPECT_EQ(handlerOf(SIGHUP), SIG_IGN);
    std::signal(SIGHUP, before);
}

} // namespace
} // namespace mural::cli
