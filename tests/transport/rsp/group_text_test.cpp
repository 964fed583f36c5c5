// Parsing of group options.
#include "transport/rsp/group_text.hpp"

#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "tests/temporary_folder.hpp"

namespace mural::rsp {
namespace {

constexpr char kSecret[] = "sixteen bytes, or a few more";

TEST(GroupText, parsesRatesInBitsBytesOrWithoutUnit) {
    const std::pair<const char*, double> all[] = {{"200mbit", 25e6},    {"1gbit", 125e6}, {"1.5Gbit", 187.5e6},
                                                  {"950kbit", 118'750}, {"25MB", 25e6},   {"3kb", 3000},
                                                  {"2GB", 2e9},         {"0", 0}};
    for (const auto& [text, bytesPerSecond] : all) {
        auto rate = parseRate(text);
        ASSERT_TRUE(rate) << text << ": " << rate.error().message;
        EXPECT_EQ(*rate, bytesPerSecond) << text;
    }
    for (const char* text : {"", "mbit", "fast", "-1mbit", "1furlong", "1 mbit", "nan", "inf", "1e999"}) {
        auto rate = parseRate(text);
        ASSERT_FALSE(rate) << text;
        EXPECT_NE(rate.error().message.find(std::string(text)), std::string::npos);
        EXPECT_NE(rate.error().message.find("write it as"), std::string::npos);
    }
}

TEST(GroupText, parsesSizesInUnitsOf1024) {
    const std::pair<const char*, uint64_t> all[] = {
        {"1000000", 1'000'000}, {"64k", 65'536}, {"1.5K", 1536}, {"256M", 256u << 20}, {"2g", uint64_t{2} << 30}};
    for (const auto& [text, sizeBytes] : all) {
        auto size = parseSize(text);
        ASSERT_TRUE(size) << text << ": " << size.error().message;
        EXPECT_EQ(*size, sizeBytes) << text;
    }
    for (const char* text : {"", "k", "-1", "64kbit", "1e300"}) EXPECT_FALSE(parseSize(text)) << text;
}

TEST(GroupText, parsesSealNames) {
    for (const Seal seal : {Seal::None, Seal::Tag, Seal::ChaCha}) {
        auto read = parseSeal(nameOf(seal));
        ASSERT_TRUE(read) << nameOf(seal) << ": " << read.error().message;
        EXPECT_EQ(*read, seal);
    }
    auto fastest = parseSeal("auto"), unknown = parseSeal("wax");
    ASSERT_TRUE(fastest);
    EXPECT_NE(*fastest, Seal::None);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("\"wax\""), std::string::npos);
}

TEST(GroupText, usesAllBytesOfASecretExceptATrailingNewline) {
    const mural::test::TemporaryFolder folder;
    const std::string text = kSecret;
    auto bare = readSecret(folder.file("bare", text, 0600)), line = readSecret(folder.file("line", text + "\n", 0600)),
         dos = readSecret(folder.file("dos", text + "\r\n", 0600)),
         other = readSecret(folder.file("other", " " + text, 0600));
    ASSERT_TRUE(bare && line && dos && other);
    EXPECT_EQ(*bare, *line);
    EXPECT_EQ(*bare, *dos);
    EXPECT_NE(*bare, *other);
}

TEST(GroupText, rejectsInvalidSecrets) {
    const mural::test::TemporaryFolder folder;
    const std::pair<std::string, const char*> all[] = {
        {folder.at("none"), "cannot read"},
        {folder.file("short", "fifteen bytes..\n", 0600), "at least 16 bytes"},
        {folder.file("empty", "", 0600), "at least 16 bytes"},
        {folder.file("read", kSecret, 0644), "every user of this machine"},
        {folder.file("written", kSecret, 0602), "every user of this machine"},
    };
    for (const auto& [path, why] : all) {
        auto secret = readSecret(path);
        ASSERT_FALSE(secret) << path;
        EXPECT_NE(secret.error().message.find(path), std::string::npos) << secret.error().message;
        EXPECT_NE(secret.error().message.find(why), std::string::npos) << secret.error().message;
    }
    EXPECT_TRUE(readSecret(folder.file("group", kSecret, 0640)));
}

} // namespace
} // namespace mural::rsp
