// Detection of a program's GL libraries from names and dependencies.
#include "nodes/launch/gl_libraries.hpp"

#include <gtest/gtest.h>

#include "nodes/launch/elf_check.hpp"
#include "tests/launch/elf_bytes.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

TEST(LibraryFacts, readNameAndDependencies) {
    const test::TemporaryFolder folder;
    folder.file("lib.so", test::library64("libGL.so.1", {"libGLdispatch.so.0", "libc.so.6"}), 0644);
    const auto facts = readLibrary(folder.at("lib.so"));
    ASSERT_TRUE(facts.ok());
    EXPECT_EQ(facts.value().soname, "libGL.so.1");
    EXPECT_EQ(facts.value().needed, (std::vector<std::string>{"libGLdispatch.so.0", "libc.so.6"}));
}

// A program's folder may contain any file: a truncated one must not be read past its end.
TEST(LibraryFacts, rejectTruncatedFiles) {
    const test::TemporaryFolder folder;
    const std::string whole = test::library64("libGL.so.1", {"libc.so.6"});
    for (size_t size = 0; size < whole.size(); ++size) {
        folder.file("cut.so", whole.substr(0, size), 0644);
        const auto facts = readLibrary(folder.at("cut.so"));
        if (!facts.ok()) continue;
        EXPECT_TRUE(std::string("libGL.so.1").starts_with(facts.value().soname));
        for (const std::string& needed : facts.value().needed)
            EXPECT_TRUE(std::string("libc.so.6").starts_with(needed));
    }
    EXPECT_FALSE(readLibrary(folder.at("none.so")).ok());
}

TEST(Drawing, isDerivedFromNameAndDependencies) {
    const test::TemporaryFolder folder;
    const auto drawing = [&](const std::string& soname, const std::vector<std::string>& needed) {
        folder.file("lib.so", test::library64(soname, needed), 0644);
        return drawingOf(folder.at("lib.so"));
    };
    EXPECT_EQ(drawing("libGL.so.1", {"libGLX.so.0", "libGLdispatch.so.0"}), Drawing::Glvnd);
    EXPECT_EQ(drawing("libGL.so.1", {"libglapi.so.0", "libX11.so.6"}), Drawing::OwnGl);
    EXPECT_EQ(drawing("libEGL.so.1", {"libc.so.6"}), Drawing::OwnGl);
    EXPECT_EQ(drawing("libGLESv2.so.2", {"libGLdispatch.so.0"}), Drawing::Glvnd);
    EXPECT_EQ(drawing("libEGL.so", {"libc.so.6"}), Drawing::None); // a browser's ANGLE, which uses the system's GL
    EXPECT_EQ(drawing("libGLEW.so.2.2", {"libGL.so.1"}), Drawing::None);
    EXPECT_EQ(drawing("libOSMesa.so.8", {}), Drawing::OffScreen);
    EXPECT_EQ(drawing("libvulkan.so.1", {}), Drawing::Vulkan);
    EXPECT_EQ(drawing("libX11.so.6", {}), Drawing::X11);
    EXPECT_EQ(drawingOf(folder.at("no-such.so")), Drawing::None);
}

TEST(OwnGlLibraries, areEmptyOnThisMachine) {
    EXPECT_TRUE(ownGlLibraries("/proc/self/exe", Environment::current()).empty());
    EXPECT_TRUE(ownGlLibraries("/no/such/program", Environment::current()).empty());
}

} // namespace
} // namespace mural::launch
