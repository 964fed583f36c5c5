// Messages of browsers, input events, rates, and the header of pictures.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/mural/page/protocol/client_message.hpp"
#include "tools/mural/page/protocol/picture_part.hpp"
#include "tools/mural/page/protocol/rate_limit.hpp"

namespace mural::page {
namespace {

template <class Kind> bool is(std::string_view text) { return std::holds_alternative<Kind>(parseClientMessage(text)); }

TEST(ClientMessage, readsAHello) {
    const ClientMessage message =
        parseClientMessage(R"({"hello":{"token":"abc","name":"Ann","canUse":{"h264":true},"px":[1280,720]}})");
    const auto& hello = std::get<HelloMessage>(message);
    EXPECT_EQ(hello.token, "abc");
    EXPECT_EQ(hello.name, "Ann");
    EXPECT_TRUE(hello.decodesH264);
    EXPECT_EQ(hello.width, 1280);
    EXPECT_EQ(hello.height, 720);
}

TEST(ClientMessage, bordersOfAHello) {
    EXPECT_TRUE(is<InvalidMessage>(R"({"hello":{}})"));
    EXPECT_TRUE(is<InvalidMessage>(R"({"hello":{"token":1}})"));
    EXPECT_TRUE(is<InvalidMessage>(R"({"hello":{"token":")" + std::string(129, 'x') + R"("}})"));
    const std::string name = std::string(63, 'x') + "\xc3\xa4"; // the character crosses the limit
    const ClientMessage message = parseClientMessage(R"({"hello":{"token":"t","name":")" + name + R"("}})");
    EXPECT_EQ(std::get<HelloMessage>(message).name, std::string(63, 'x'));
}

TEST(ClientMessage, readsRequests) {
    const ClientMessage message = parseClientMessage(R"({"id":7,"op":"layout","args":{"canvas":"wall"}})");
    const auto& request = std::get<RequestMessage>(message);
    EXPECT_EQ(request.id, 7);
    EXPECT_EQ(request.operation, "layout");
    EXPECT_EQ(request.arguments["canvas"], "wall");
}

TEST(ClientMessage, invalidOnesKeepTheirId) {
    const ClientMessage message = parseClientMessage(R"({"id":7,"op":5})");
    EXPECT_EQ(std::get<InvalidMessage>(message).id, 7);
    for (const char* wrong :
         {"", "[]", "7", "{", "{\"ack\":{}}", "{\"ping\":\"x\"}", "{\"ping\":1,\"ack\":{}}", "\xff"})
        EXPECT_TRUE(is<InvalidMessage>(wrong)) << wrong;
}

TEST(ClientMessage, refusesDeepAndLongOnes) {
    std::string deep = R"({"input":)";
    for (int i = 0; i < 100'000; ++i) deep += "[";
    EXPECT_TRUE(is<InvalidMessage>(deep.substr(0, 60'000)));
    EXPECT_TRUE(is<InvalidMessage>(std::string(kMaxTextMessageBytes + 1, ' ')));
}

TEST(ClientMessage, readsAcksAndPings) {
    EXPECT_EQ(std::get<AckMessage>(parseClientMessage(R"({"ack":{"frame":12,"shownMs":4.5}})")).frame, 12U);
    EXPECT_EQ(std::get<PingMessage>(parseClientMessage(R"({"ping":4.5})")).time, 4.5);
}

TEST(InputEvent, readsEveryKind) {
    for (const char* valid :
         {R"({"input":{"seq":1,"kind":"move","x":0,"y":1}})",
          R"({"input":{"seq":1,"kind":"down","x":0.5,"y":0.5,"button":3}})",
          R"({"input":{"seq":1,"kind":"wheel","dx":0,"dy":-120}})",
          R"({"input":{"seq":1,"kind":"key","key":"a","code":"KeyA","down":true}})",
          R"({"input":{"seq":1,"kind":"text","text":"pasted"}})", R"({"input":{"seq":4294967295,"kind":"blur"}})"})
        EXPECT_TRUE(is<input::InputEvent>(valid)) << valid;
}

TEST(InputEvent, refusesWhatIsOutOfRange) {
    for (const char* wrong :
         {R"({"input":{"seq":1,"kind":"move","x":1.1,"y":0}})", R"({"input":{"seq":1,"kind":"move","x":0}})",
          R"({"input":{"seq":-1,"kind":"blur"}})", R"({"input":{"seq":4294967296,"kind":"blur"}})",
          R"({"input":{"seq":1,"kind":"down","x":0,"y":0,"button":10}})", R"({"input":{"seq":1,"kind":"jump"}})",
          R"({"input":{"seq":1,"kind":"wheel","dy":1e300}})", R"({"input":{"seq":1,"kind":"key","key":"a"}})",
          R"({"input":{"seq":1,"kind":"blur","more":1}})", R"({"input":[]})"})
        EXPECT_TRUE(is<InvalidMessage>(wrong)) << wrong;
}

TEST(PartHeader, isLittleEndianWithoutGaps) {
    PartHeader header;
    header.kind = PartKind::Png;
    header.flags = kKeyFrame | kStill;
    header.stream = 0x01020304;
    header.frame = 0x1112131415161718;
    header.lastInput = 0x21222324;
    header.x = 0x3132;
    header.pictureHeight = 0x4142;
    const std::string bytes = partHeaderBytes(header, 0x51525354);
    ASSERT_EQ(bytes.size(), kPartHeaderBytes);
    EXPECT_EQ(bytes.substr(0, 8), std::string("\x01\x04\x05\x00\x04\x03\x02\x01", 8));
    EXPECT_EQ(bytes.substr(8, 8), "\x18\x17\x16\x15\x14\x13\x12\x11");
    EXPECT_EQ(bytes.substr(16, 6), "\x24\x23\x22\x21\x32\x31");
    EXPECT_EQ(bytes.substr(30, 6), "\x42\x41\x54\x53\x52\x51");
}

TEST(RateLimit, permitsABurstThenTheRate) {
    RateLimit limit(20);
    constexpr int64_t kSecond = 1'000'000'000;
    int passed = 0;
    for (int i = 0; i < 100; ++i) passed += limit.take(kSecond) ? 1 : 0;
    EXPECT_EQ(passed, 20);
    for (int i = 0; i < 100; ++i) passed += limit.take(kSecond + i * kSecond / 100) ? 1 : 0;
    EXPECT_NEAR(passed, 40, 1);
    EXPECT_TRUE(limit.take(100 * kSecond));
}

} // namespace
} // namespace mural::page
