// Classification of program files by their headers.
#include "nodes/launch/elf_check.hpp"

#include <gtest/gtest.h>

#include "tests/launch/elf_bytes.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

class ElfCheck : public ::testing::Test {
protected:
    ExecutableFacts factsOf(const std::string& bytes) {
        auto facts = readExecutable(folder_.file("program", bytes, 0755));
        EXPECT_TRUE(facts.ok());
        return facts.value();
    }
    test::TemporaryFolder folder_;
};

TEST_F(ElfCheck, recognisesThisProgramAsDynamic) {
    const auto facts = readExecutable("/proc/self/exe");
    ASSERT_TRUE(facts.ok());
    EXPECT_EQ(facts.value().kind, FileKind::Elf);
    EXPECT_EQ(facts.value().bits, ownBits());
    EXPECT_TRUE(facts.value().hasInterpreter);
    EXPECT_EQ(facts.value().machine, ownMachine());
    EXPECT_NE(ownMachine(), EM_NONE);
}

TEST_F(ElfCheck, detectsTheMissingInterpreterOfAStaticProgram) {
    EXPECT_TRUE(factsOf(test::elf64(true, EM_X86_64)).hasInterpreter);
    EXPECT_FALSE(factsOf(test::elf64(false, EM_X86_64)).hasInterpreter);
}

TEST_F(ElfCheck, readsThe32BitHeader) {
    const ExecutableFacts facts = factsOf(test::elf32());
    EXPECT_EQ(facts.kind, FileKind::Elf);
    EXPECT_EQ(facts.bits, 32);
    EXPECT_EQ(facts.machine, EM_386);
}

TEST_F(ElfCheck, treatsATruncatedFileAsUnknown) {
    EXPECT_EQ(factsOf(test::elf64(true, EM_X86_64).substr(0, 20)).kind, FileKind::Unknown);
    EXPECT_EQ(factsOf("\x7f"
                      "ELF\x09 and more")
                  .kind,
              FileKind::Unknown);
}

TEST_F(ElfCheck, ignoresInvalidHeaderCounts) {
    std::string bytes = test::elf64(true, EM_X86_64);
    auto* header = reinterpret_cast<Elf64_Ehdr*>(bytes.data());
    header->e_phnum = 0xfffe;
    EXPECT_FALSE(factsOf(bytes).hasInterpreter);
    header->e_phnum = 2;
    header->e_phoff = ~uint64_t{0} - 4;
    EXPECT_FALSE(factsOf(bytes).hasInterpreter);
}

TEST_F(ElfCheck, splitsTheScriptLine) {
    const ExecutableFacts facts = factsOf("#! \t/usr/bin/env  python3 -u \necho\n");
    EXPECT_EQ(facts.kind, FileKind::Script);
    EXPECT_EQ(facts.scriptInterpreter, "/usr/bin/env");
    EXPECT_EQ(facts.scriptArgument, "python3 -u");
    EXPECT_EQ(factsOf("#!/bin/sh").scriptInterpreter, "/bin/sh");
}

TEST_F(ElfCheck, treatsTextAsAShellScriptAndBytesAsUnknown) {
    EXPECT_EQ(factsOf("echo hello\n").kind, FileKind::PlainScript);
    EXPECT_EQ(factsOf(std::string("ab\0cd\n", 6)).kind, FileKind::Unknown);
}

TEST_F(ElfCheck, namesAMissingFile) {
    const auto facts = readExecutable(folder_.at("nothing"));
    ASSERT_FALSE(facts.ok());
    EXPECT_NE(facts.error().message.find("nothing"), std::string::npos);
}

} // namespace
} // namespace mural::launch
