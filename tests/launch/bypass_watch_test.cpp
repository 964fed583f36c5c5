// Detection of programs that draw without the capture library, and the message about them.
#include "nodes/launch/bypass_watch.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/launch/elf_bytes.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

class Bypass : public ::testing::Test {
protected:
    std::string library(const std::string& name, const std::vector<std::string>& needed) {
        folder_.file(name, test::library64(name, needed), 0644);
        return folder_.at(name);
    }
    test::TemporaryFolder folder_;
};

TEST_F(Bypass, namesAGlLibraryOfTheProgram) {
    const std::string own = library("libGL.so.1", {"libglapi.so.0"});
    const std::string line = describeBypass({{"/opt/app/bin/app", {library("libX11.so.6", {}), own}}});
    EXPECT_NE(line.find("app uses " + own), std::string::npos) << line;
    EXPECT_NE(line.find("--capture-via preload"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST_F(Bypass, reportsNothingWithTheCaptureLibrary) {
    const std::string own = library("libGL.so.1", {"libglapi.so.0"});
    EXPECT_EQ(describeBypass({{"app", {own, "/opt/mural/lib/libmural_preload.so", library("libX11.so.6", {})}}}), "");
}

TEST_F(Bypass, distinguishesOffScreenVulkanAndX11) {
    const std::string x11 = library("libX11.so.6", {});
    EXPECT_NE(describeBypass({{"app", {x11, library("libOSMesa.so.8", {})}}}).find("OSMesa"), std::string::npos);
    EXPECT_NE(describeBypass({{"app", {x11, library("libvulkan.so.1", {})}}}).find("Vulkan"), std::string::npos);
    EXPECT_NE(describeBypass({{"app", {x11}}}).find("no GL library"), std::string::npos);
    EXPECT_EQ(describeBypass({{"app", {x11, library("libGL.so.1", {"libGLdispatch.so.0"})}}}), ""); // it may yet draw
    EXPECT_EQ(describeBypass({{"sh", {}}}), "");
}

TEST_F(Bypass, reportsNoX11ForProgramsThatFailBeforeLoadingGl) {
    const std::string x11 = library("libX11.so.6", {});
    EXPECT_EQ(describeBypass({{"app", {x11}}}, true), "");
    EXPECT_NE(describeBypass({{"app", {x11, library("libOSMesa.so.8", {})}}}, true).find("OSMesa"), std::string::npos);
}

TEST_F(Bypass, reportsTheProgramBesideALaunchersDialog) {
    const std::string x11 = library("libX11.so.6", {});
    const std::string own = library("libGL.so.1", {"libglapi.so.0"});
    for (const auto& programs : {std::vector<UncapturedProgram>{{"dialog", {x11}}, {"app", {own}}},
                                 std::vector<UncapturedProgram>{{"app", {own}}, {"dialog", {x11}}}}) {
        EXPECT_EQ(describeBypass(programs).find("app uses "), 0u);
    }
}

TEST(BypassWatch, returnCompleteLinesOnce) {
    auto watch = BypassWatch::create();
    ASSERT_TRUE(watch.ok());
    BypassWatch& w = *watch.value();
    std::ofstream notes(w.notesPath(), std::ios::app);
    notes << "say\tfirst\nsay\tfirst\nnonsense\nsay\tsec" << std::flush;
    EXPECT_EQ(w.newLines(), std::vector<std::string>{"first"});
    notes << "ond\nsay\tfirst\n" << std::flush;
    EXPECT_EQ(w.newLines(), std::vector<std::string>{"second"});
    EXPECT_TRUE(w.newLines().empty());
}

TEST_F(Bypass, remembersLibrariesOfEndedPrograms) {
    auto watch = BypassWatch::create();
    ASSERT_TRUE(watch.ok());
    std::ofstream(watch.value()->notesPath(), std::ios::app)
        << "ended\t/bin/app\t" << library("libOSMesa.so.8", {}) << "\n";
    watch.value()->newLines();
    EXPECT_NE(watch.value()->describeEnded(false).find("app draws with OSMesa"), std::string::npos);
}

TEST_F(Bypass, reportsGlWithoutTheCaptureLibrary) {
    const std::string gl = library("libGL.so.1", {"libGLdispatch.so.0"}), x11 = library("libX11.so.6", {});
    const std::string line = describeUncaptured({"/opt/app/bin/app", {x11, gl}});
    EXPECT_EQ(line.find("app uses GL (" + gl + ") without the capture library"), 0u) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(describeUncaptured({"app", {gl, "/opt/mural/lib/libGLX_mural.so.0"}}), "");
    EXPECT_EQ(describeUncaptured({"app", {x11}}), "");
}

TEST(BypassWatch, ignoreProcessesThatEnded) {
    auto watch = BypassWatch::create();
    ASSERT_TRUE(watch.ok());
    EXPECT_EQ(watch.value()->describeRunning({}), "");
    EXPECT_EQ(watch.value()->describeRunning({-1}), ""); // gone meanwhile
    EXPECT_EQ(watch.value()->describeUncaptured({-1}), "");
}

} // namespace
} // namespace mural::launch
