// Checks of a program before its start.
#include "nodes/launch/program_check.hpp"

#include <gtest/gtest.h>

#include "nodes/launch/elf_check.hpp"
#include "tests/launch/elf_bytes.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

class ProgramCheckTest : public ::testing::Test {
protected:
    std::string program(const std::string& name, int mode = 0755) {
        return folder_.file(name, test::elf64(true, ownMachine()), mode);
    }
    // Expects a rejection with this status, in one line that contains the word.
    void expectRefusal(const std::string& path, int status, const std::string& word) {
        const ProgramCheck check = checkProgram(path, "");
        EXPECT_EQ(check.exitStatus, status) << check.message;
        EXPECT_NE(check.message.find(word), std::string::npos) << check.message;
        EXPECT_EQ(check.message.find('\n'), std::string::npos);
    }
    test::TemporaryFolder folder_;
};

TEST_F(ProgramCheckTest, acceptsADynamicProgram) {
    const std::string path = program("app");
    const ProgramCheck check = checkProgram(path, "");
    EXPECT_TRUE(check.ok()) << check.message;
    EXPECT_EQ(check.path, path);
}

TEST_F(ProgramCheckTest, returnsTheStatusesOfAShell) {
    expectRefusal(folder_.at("none"), 127, "No such file");
    expectRefusal(program("noright", 0644), 126, "chmod");
    expectRefusal(folder_.at("."), 126, "folder");
    EXPECT_EQ(checkProgram("surely-not-installed", "/usr/bin").exitStatus, 127);
    EXPECT_EQ(checkProgram("", "/usr/bin").exitStatus, 127);
}

TEST_F(ProgramCheckTest, rejectsProgramsWithoutPreloading) {
    expectRefusal(program("setuid", 04755), 2, "setuid");
    expectRefusal(program("setgid", 02755), 2, "setgid");
    expectRefusal(folder_.file("static", test::elf64(false, ownMachine()), 0755), 2, "static");
    expectRefusal(folder_.file("narrow", test::elf32(), 0755), 2, "32-bit");
    expectRefusal(folder_.file("foreign", test::elf64(true, EM_S390), 0755), 2, "processor");
    expectRefusal(folder_.file("noise", std::string("\1\0\2", 3), 0755), 126, "neither");
}

TEST_F(ProgramCheckTest, followsScriptsToTheirInterpreter) {
    const std::string good = folder_.file("good", "#!" + program("interpreter") + " -x\n", 0755);
    EXPECT_TRUE(checkProgram(good, "").ok());
    EXPECT_EQ(checkProgram(good, "").path, good);
    expectRefusal(
        folder_.file("bad", "#!" + folder_.file("static", test::elf64(false, ownMachine()), 0755) + "\n", 0755), 2,
        "static");
    expectRefusal(folder_.file("lost", "#!" + folder_.at("gone") + "\n", 0755), 127, "gone");
    EXPECT_TRUE(checkProgram(folder_.file("second", "#!" + good + "\n", 0755), "").ok());
    const std::string loop = folder_.at("loop");
    folder_.file("loop", "#!" + loop + "\n", 0755);
    expectRefusal(loop, 126, "scripts");
}

TEST_F(ProgramCheckTest, runsPlainTextInTheShell) {
    EXPECT_TRUE(checkProgram(folder_.file("text", "exit 0\n", 0755), "").ok());
}

TEST_F(ProgramCheckTest, searchesPathInOrderAndSkipsNonExecutables) {
    const test::TemporaryFolder first;
    const test::TemporaryFolder second;
    first.file("app", test::elf64(true, ownMachine()), 0644);
    const std::string wanted = second.file("app", test::elf64(true, ownMachine()), 0755);
    program("app");
    const std::string path = first.at("") + ":" + second.at("") + ":" + folder_.at("");
    EXPECT_EQ(std::filesystem::path(findProgram("app", path).path).lexically_normal(),
              std::filesystem::path(wanted).lexically_normal());
    EXPECT_EQ(findProgram("app", first.at("")).exitStatus, 126);
}

} // namespace
} // namespace mural::launch
