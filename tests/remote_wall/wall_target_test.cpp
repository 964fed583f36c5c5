// Values of --send.
#include <gtest/gtest.h>

#include "nodes/remote_wall/wall_target.hpp"

namespace mural::remote {
namespace {

TEST(WallTarget, hasDefaults) {
    const auto target = wallTargetOf("museum=wall.example:4281");
    ASSERT_TRUE(target) << target.error().message;
    EXPECT_EQ(target->name, "museum");
    EXPECT_EQ(target->host, "wall.example");
    EXPECT_EQ(target->port, 4281);
    EXPECT_EQ(target->codec, "jpeg-100");
    EXPECT_EQ(target->tile, 512);
    EXPECT_EQ(target->rate, 60);
    EXPECT_EQ(target->input, input::InputPermission::Off);
}

TEST(WallTarget, readsAllSettings) {
    const auto target = wallTargetOf("a-1=[::1]:99,codec=auto,tile=256,rate=30,input=display,secret=/etc/key");
    ASSERT_TRUE(target) << target.error().message;
    EXPECT_EQ(target->host, "::1");
    EXPECT_EQ(target->codec, "auto");
    EXPECT_EQ(target->tile, 256);
    EXPECT_EQ(target->rate, 30);
    EXPECT_EQ(target->input, input::InputPermission::Any);
    EXPECT_EQ(target->secretFile, "/etc/key");
    EXPECT_EQ(wallTargetOf("a=b:1,input=on")->input, input::InputPermission::Private);
}

TEST(WallTarget, namesTheWrongPart) {
    const std::pair<const char*, const char*> wrong[] = {
        {"wall:4281", "NAME=HOST:PORT"},
        {"=wall:4281", "name"},
        {"a b=wall:4281", "name"},
        {"a=wall", "HOST:PORT"},
        {"a=:4281", "HOST:PORT"},
        {"a=wall:0", "HOST:PORT"},
        {"a=wall:1,codec=mp3", "mp3"},
        {"a=wall:1,tile=9", "tile=9"},
        {"a=wall:1,rate=0", "rate=0"},
        {"a=wall:1,rate=9x", "rate=9x"},
        {"a=wall:1,input=yes", "yes"},
        {"a=wall:1,secret=", "secret"},
        {"a=wall:1,colour=red", "\"colour\""},
        {"a=wall:1,", "setting"},
    };
    for (const auto& [text, part] : wrong) {
        const auto target = wallTargetOf(text);
        ASSERT_FALSE(target) << text;
        EXPECT_NE(target.error().message.find(part), std::string::npos) << target.error().message;
        EXPECT_EQ(target.error().message.find('\n'), std::string::npos);
    }
}

} // namespace
} // namespace mural::remote
