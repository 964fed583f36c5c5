// Valid plug-ins carry bytes; others are rejected with a one-line reason.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <vector>

#include "transport/plugin/plugin_connection.hpp"
#include "transport/plugin/plugin_library.hpp"

namespace mural {

namespace {

const std::string kFolder = MURAL_TEST_PLUGINS;

void expectRefused(const std::string& scheme, const std::string& reason, const std::string& folder = kFolder) {
    const auto plugin = openPlugin(scheme, folder);
    ASSERT_FALSE(plugin) << scheme;
    const std::string& message = plugin.error().message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_NE(message.find("libmural_transport_" + scheme + ".so"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

} // namespace

TEST(Plugin, isRejectedWithAReason) {
    expectRefused("nobodyhas", "the plug-in is missing");
    expectRefused("noentry", "has no function mural_get_transport_plugin");
    expectRefused("older", "version 0");
    expectRefused("short", "truncated");
    expectRefused("renamed", "implements the scheme \"other\"");
}

TEST(Plugin, isRejectedWhenItIsNoLibrary) {
    const auto folder = std::filesystem::temp_directory_path() / ("mural_plugin_test." + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    std::ofstream(folder / "libmural_transport_text.so") << "no library\n";
    expectRefused("text", "cannot load the plug-in", folder.string());
    std::filesystem::remove_all(folder);
}

TEST(Plugin, carriesBytesAndErrors) {
    const auto plugin = openPlugin("wrapped", kFolder);
    ASSERT_TRUE(plugin) << plugin.error().message;
    auto listener = listenByPlugin(*plugin.value(), "wrapped://127.0.0.1:0");
    ASSERT_TRUE(listener) << listener.error().message;
    const std::string text = (*listener)->describe();
    EXPECT_TRUE(text.starts_with("wrapped://127.0.0.1:")) << text;
    const auto nobody = (*listener)->accept(Deadline::inMs(20));
    ASSERT_FALSE(nobody);
    EXPECT_NE(nobody.error().message.find("without a connection"), std::string::npos) << nobody.error().message;
    auto a = connectByPlugin(*plugin.value(), text, Deadline::inMs(5000));
    ASSERT_TRUE(a) << a.error().message;
    auto b = (*listener)->accept(Deadline::inMs(5000));
    ASSERT_TRUE(b) << b.error().message;

    std::vector<std::byte> five(5, std::byte{5});
    std::vector<std::byte> got(5);
    ASSERT_TRUE((*a)->write(five, Deadline::never()));
    (*a)->flush();
    ASSERT_TRUE((*b)->read(got, Deadline::never()));
    EXPECT_EQ(got, five);
    EXPECT_EQ((*a)->bytesWritten(), 5u);
    EXPECT_EQ((*b)->bytesRead(), 5u);
    EXPECT_FALSE((*b)->read(got, Deadline::inMs(20)));
    EXPECT_TRUE((*b)->timedOut());
    EXPECT_TRUE((*b)->alive());
    (*a)->close();
    const auto end = (*b)->read(got, Deadline::inMs(5000));
    ASSERT_FALSE(end);
    EXPECT_NE(end.error().message.find("the peer has closed the connection"), std::string::npos) << end.error().message;
    EXPECT_FALSE((*b)->alive());
    EXPECT_FALSE((*b)->timedOut());
}

} // namespace mural
