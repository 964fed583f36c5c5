// The environment of a captured program.
#include "nodes/launch/environment.hpp"

#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace mural::launch {
namespace {

const CaptureLibrary kLibrary{"/opt/mural/lib/libGLX_mural.so.0", "/opt/mural/lib/mural_egl_vendor.json"};

TEST(Preload, keepsOtherEntriesAndComesLast) {
    EXPECT_EQ(withCapture("", kLibrary.path), kLibrary.path);
    EXPECT_EQ(withCapture("/a.so", kLibrary.path), "/a.so " + kLibrary.path);
    EXPECT_EQ(withCapture("/a.so:/b.so  c.so", kLibrary.path), "/a.so /b.so c.so " + kLibrary.path);
}

TEST(Preload, isIdempotentAndRemovesAnEarlierMural) {
    const std::string once = withCapture("/a.so", kLibrary.path);
    EXPECT_EQ(withCapture(once, kLibrary.path), once);
    EXPECT_EQ(withCapture("/old/libGLX_mural.so.0 /a.so", kLibrary.path), once);
    EXPECT_EQ(withoutCapture("/old/libGLX_mural.so.0:/a.so:libGLX_mural.so.0"), "/a.so");
    EXPECT_EQ(withoutCapture("/x/notlibGLX_mural.so.0"), "/x/notlibGLX_mural.so.0");
}

TEST(Environment, matchesWholeNamesInSetAndGet) {
    Environment e({"AB=1", "A=2"});
    EXPECT_EQ(e.get("A"), "2");
    EXPECT_EQ(e.get("B"), std::nullopt);
    e.set("AB", "3");
    EXPECT_EQ(e.get("AB"), "3");
    EXPECT_EQ(e.entries().size(), 2u);
    e.unset("A");
    EXPECT_EQ(e.get("A"), std::nullopt);
    EXPECT_EQ(e.get("AB"), "3");
}

TEST(CaptureEnvironment, setsTheVariablesOfBothEntries) {
    Environment e({"LD_PRELOAD=/grab.so"});
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    EXPECT_EQ(e.get("LD_PRELOAD"), "/grab.so " + kLibrary.path);
    EXPECT_EQ(e.get("__GLX_VENDOR_LIBRARY_NAME"), "mural");
    EXPECT_EQ(e.get("__EGL_VENDOR_LIBRARY_FILENAMES"), kLibrary.eglVendorFile);
    EXPECT_EQ(e.get("MURAL_SESSION"), "mural-1");
    EXPECT_EQ(e.get("MURAL_REAL_GLX_VENDOR"), std::nullopt);
    EXPECT_EQ(e.get("MURAL_REAL_EGL_VENDORS"), std::nullopt);
}

TEST(CaptureEnvironment, preloadsTheSecondLibraryOnlyOnRequest) {
    const std::string both = kLibrary.path + " /opt/mural/lib/libmural_preload.so";
    Environment e({"LD_PRELOAD=/grab.so"});
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1", CaptureEntries::VendorAndPreload).ok());
    EXPECT_EQ(e.get("LD_PRELOAD"), "/grab.so " + both);
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1", CaptureEntries::VendorAndPreload).ok());
    EXPECT_EQ(e.get("LD_PRELOAD"), "/grab.so " + both);
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    EXPECT_EQ(e.get("LD_PRELOAD"), "/grab.so " + kLibrary.path);
}

TEST(CaptureEnvironment, savesTheUsersVendorsEvenWhenAddedTwice) {
    Environment e({"__GLX_VENDOR_LIBRARY_NAME=mesa", "__EGL_VENDOR_LIBRARY_FILENAMES=/v/50_mesa.json"});
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    const auto once = e.entries();
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    EXPECT_EQ(std::multiset<std::string>(once.begin(), once.end()),
              std::multiset<std::string>(e.entries().begin(), e.entries().end()));
    EXPECT_EQ(e.get("MURAL_REAL_GLX_VENDOR"), "mesa");
    EXPECT_EQ(e.get("MURAL_REAL_EGL_VENDORS"), "/v/50_mesa.json");
}

TEST(CaptureEnvironment, discardsStaleSavedVendors) {
    Environment e({"MURAL_REAL_GLX_VENDOR=old"});
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    EXPECT_EQ(e.get("MURAL_REAL_GLX_VENDOR"), std::nullopt);
}

TEST(CaptureEnvironment, restoresTheOriginalGlForNodes) {
    Environment e({"HOME=/h", "LD_PRELOAD=/clock.so", "__GLX_VENDOR_LIBRARY_NAME=mesa"});
    ASSERT_TRUE(addCapture(e, kLibrary, "mural-1").ok());
    removeCapture(e);
    EXPECT_EQ(std::multiset<std::string>(e.entries().begin(), e.entries().end()),
              (std::multiset<std::string>{"HOME=/h", "__GLX_VENDOR_LIBRARY_NAME=mesa"}));
}

TEST(CaptureEnvironment, usesTheLibraryPathForAFolderWithSpaces) {
    const CaptureLibrary spaced{"/my wall/lib/libGLX_mural.so.0", "/my wall/lib/mural_egl_vendor.json"};
    Environment e({"LD_LIBRARY_PATH=/x"});
    ASSERT_TRUE(addCapture(e, spaced, "s").ok());
    ASSERT_TRUE(addCapture(e, spaced, "s").ok());
    EXPECT_EQ(e.get("LD_PRELOAD"), "libGLX_mural.so.0");
    EXPECT_EQ(e.get("LD_LIBRARY_PATH"), "/my wall/lib:/x");
}

TEST(CaptureEnvironment, rejectsAFolderThatTheLoaderCannotName) {
    Environment e;
    EXPECT_FALSE(addCapture(e, {"/a:b/libGLX_mural.so.0", ""}, "s").ok());
}

TEST(CaptureLibraryPlace, isFoundInTheBuildTreeAndInstalled) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.at("lib"));
    EXPECT_FALSE(findCaptureLibrary(folder.at("bin/mural")).ok());
    folder.file("lib/libGLX_mural.so.0", "", 0644);
    EXPECT_EQ(findCaptureLibrary(folder.at("bin/mural")).value().path, folder.at("lib/libGLX_mural.so.0"));
    std::filesystem::create_directories(folder.at("lib/mural"));
    EXPECT_FALSE(findCaptureLibrary(folder.at("bin/mural")).ok());
    folder.file("lib/mural/libGLX_mural.so.0", "", 0644);
    EXPECT_EQ(findCaptureLibrary(folder.at("bin/mural")).value().path, folder.at("lib/mural/libGLX_mural.so.0"));
}

} // namespace
} // namespace mural::launch
