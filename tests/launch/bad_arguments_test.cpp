// The built command with every user error: one line on standard error, nothing on standard output, the documented
// status, and no remaining process.
#include <cstdio>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

#include "nodes/launch/child_process.hpp"
#include "nodes/launch/elf_check.hpp"
#include "tests/launch/elf_bytes.hpp"
#include "tests/temporary_folder.hpp"

namespace mural {
namespace {

struct CommandResult {
    int status = -1;
    std::string output, errors;
};

std::string contentOf(int fd) {
    std::string text(65536, '\0');
    text.resize(static_cast<size_t>(std::max<ssize_t>(0, pread(fd, text.data(), text.size(), 0))));
    close(fd);
    return text;
}

CommandResult mural(std::vector<std::string> words, std::vector<std::string> environment = {},
                    const char* outputFile = nullptr) {
    launch::SpawnRequest request;
    request.file = MURAL_BINARY;
    request.arguments = {"mural"};
    request.arguments.insert(request.arguments.end(), words.begin(), words.end());
    request.environment = {"PATH=/usr/bin:/bin"};
    request.environment.insert(request.environment.end(), environment.begin(), environment.end());
    request.outputFd =
        outputFile != nullptr ? open(outputFile, O_WRONLY | O_CLOEXEC) : memfd_create("output", MFD_CLOEXEC);
    request.errorFd = memfd_create("errors", MFD_CLOEXEC);
    CommandResult result;
    auto child = launch::ChildProcess::start(request);
    EXPECT_TRUE(child.ok());
    EXPECT_TRUE(child.value().waitUntil(Deadline::inMs(60'000)));
    result.status = child.value().exitStatus();
    result.output = contentOf(request.outputFd);
    result.errors = contentOf(request.errorFd);
    return result;
}

void expectOneLine(const CommandResult& result, int status, const std::string& word) {
    EXPECT_EQ(result.status, status) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.errors.empty() ? ' ' : result.errors.back(), '\n');
    EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
}

TEST(BadArguments, areReportedForTheCommandItself) {
    expectOneLine(mural({}), 2, "command is required");
    expectOneLine(mural({"rnu"}), 2, "rnu");
    expectOneLine(mural({"--nope"}), 2, "--nope");
    expectOneLine(mural({"version", "--nope"}), 2, "--nope");
    expectOneLine(mural({"node"}), 2, "--connect");
    expectOneLine(mural({"head"}), 2, "--control-fd");
    expectOneLine(mural({"head", "--control-fd", "x"}), 2, "--control-fd");
}

// Incomplete output would look complete to a later reader.
TEST(BadArguments, includeLostOutput) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"version"},
                                                  {"list-commands"},
                                                  {"list-commands", "--unsupported"},
                                                  {"run", "--help"},
                                                  {"run", "--print-config", "--tiles", "3x2"}}) {
        SCOPED_TRACE(words.front());
        expectOneLine(mural(words, {}, "/dev/full"), 1, "the output cannot be written: No space left");
    }
}

TEST(BadArguments, includeUnwritableFilesBeforeTheRun) {
    test::TemporaryFolder folder;
    expectOneLine(mural({"run", "--report", "/nodir/r.json", "--", "true"}), 2,
                  "--report /nodir/r.json: cannot be written");
    expectOneLine(mural({"run", "--report", "/tmp", "--", "true"}), 2, "is a folder");
    expectOneLine(mural({"run", "--out", folder.at("shots"), "--frames", "10", "--save", "4,45", "--", "true"}), 2,
                  "after the last one, 10");
}

TEST(BadArguments, includeAWallThatNoNodeCanDraw) {
    expectOneLine(mural({"run", "--size", "20000x100", "--", "true"}), 2, "choose a smaller --size");
}

TEST(GoodArguments, reportPicturesOfAnEarlierRun) {
    test::TemporaryFolder folder;
    const auto isReported = [&](const std::string& out) {
        return mural({"run", "--tiles", "1x1", "--display", "none", "--out", out, "--", "true"})
                   .errors.find("2 pictures of an earlier run") != std::string::npos;
    };
    folder.file("frame-000001.png", {}, 0644);
    folder.file("frame-000002.png", {}, 0644);
    folder.file("other.png", {}, 0644);
    EXPECT_TRUE(isReported(folder.at("")));
    EXPECT_FALSE(isReported(folder.at("empty")));
    EXPECT_FALSE(isReported(folder.at("film.mp4")));
}

TEST(GoodArguments, printTheVersionByCommandAndByFlag) {
    const CommandResult byCommand = mural({"version"});
    const CommandResult byFlag = mural({"--version"});
    EXPECT_EQ(byCommand.status, 0);
    EXPECT_EQ(byFlag.status, 0);
    EXPECT_EQ(byCommand.output.rfind("mural ", 0), 0U) << byCommand.output;
    EXPECT_EQ(byFlag.output, byCommand.output);
    EXPECT_EQ(byFlag.errors, "");
}

TEST(BadArguments, areReportedForRun) {
    expectOneLine(mural({"run"}), 2, "no program");
    expectOneLine(mural({"run", "--"}), 2, "no program");
    expectOneLine(mural({"run", "--tilez", "2x2", "--", "true"}), 2, "--tilez");
    expectOneLine(mural({"run", "--tiles"}), 2, "requires a value");
    expectOneLine(mural({"run", "--tiles", "2y2", "--", "true"}), 2, "COLUMNSxROWS");
    expectOneLine(mural({"run", "--size", "0x0", "--", "true"}), 2, "--size");
    expectOneLine(mural({"run", "--frames", "many", "--", "true"}), 2, "--frames");
    expectOneLine(mural({"run", "--verify=x", "--", "true"}), 2, "--verify");
    expectOneLine(mural({"run", "--out", "wall.jpg", "--", "true"}), 2, "jpg");
    expectOneLine(mural({"run", "--out", "/proc/none", "--", "true"}), 2, "--out");
    expectOneLine(mural({"run", "--gl", "vulkan", "--", "true"}), 2, "osmesa");
}

TEST(BadArguments, includeMissingDisplays) {
    expectOneLine(mural({"run", "--display", "app", "--", "true"}), 2, "DISPLAY");
    expectOneLine(mural({"run", "--display", "windows", "--", "true"}), 2, "DISPLAY");
    expectOneLine(mural({"run", "--", "true"}, {"DISPLAY=:7654"}), 2, ":7654");
}

TEST(BadArguments, includeProgramsThatCannotBeCaptured) {
    const test::TemporaryFolder folder;
    const auto program = [&](const std::string& name, int mode) {
        return folder.file(name, test::elf64(true, launch::ownMachine()), mode);
    };
    expectOneLine(mural({"run", "--", "surely-not-installed"}), 127, "PATH");
    expectOneLine(mural({"run", "--", folder.at("none")}), 127, "none");
    expectOneLine(mural({"run", "--", program("noright", 0644)}), 126, "chmod");
    expectOneLine(mural({"run", "--", folder.at("")}), 126, "folder");
    expectOneLine(mural({"run", "--", program("setuid", 04755)}), 2, "setuid");
    expectOneLine(mural({"run", "--", program("setgid", 02755)}), 2, "setgid");
    expectOneLine(mural({"run", "--", folder.file("static", test::elf64(false, launch::ownMachine()), 0755)}), 2,
                  "static");
    expectOneLine(mural({"run", "--", folder.file("narrow", test::elf32(), 0755)}), 2, "32-bit");
    expectOneLine(mural({"run", "--native", "--", folder.at("none")}), 127, "none");
}

TEST(Help, hasExamplesAndExitStatusForEveryCommand) {
    for (const char* command : {"run", "head", "node", "doctor", "list-commands", "version"}) {
        const CommandResult result = mural({command, "--help"});
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.errors, "");
        EXPECT_NE(result.output.find("Example"), std::string::npos) << command;
        EXPECT_NE(result.output.find("Exit status"), std::string::npos) << command;
        EXPECT_NE(result.output.find(std::string("mural ") + command), std::string::npos) << command;
    }
}

} // namespace
} // namespace mural
