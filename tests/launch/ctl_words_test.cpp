// The words of mural ctl, and its texts, without a session.
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "tools/mural/ctl/command_words.hpp"
#include "tools/mural/ctl/reply_text.hpp"

namespace mural::cli {
namespace {

using Json = nlohmann::json;

Json argument(const char* name, const char* kind) { return {{"name", name}, {"kind", kind}, {"required", true}}; }

Json sampleOperations() {
    return Json::array(
        {{{"name", "status"}, {"usage", "status"}, {"meaning", "the state"}, {"arguments", Json::array()}},
         {{"name", "log-level"},
          {"usage", "log-level [LEVELS]"},
          {"meaning", "levels"},
          {"arguments", Json::array({argument("levels", "text")})}},
         {{"name", "remove-node"},
          {"usage", "remove-node NODE [force]"},
          {"meaning", "end a node"},
          {"arguments", Json::array({argument("node", "whole number"), argument("force", "truth value")})}},
         {{"name", "equalizer-set"},
          {"usage", "equalizer NAME set PARAMETER VALUE"},
          {"meaning", "set"},
          {"arguments", Json::array({argument("name", "text"), argument("parameter", "text"),
                                     argument("value", "text, number or truth value")})}},
         {{"name", "record-start"},
          {"usage", "record start FILE"},
          {"meaning", "record"},
          {"arguments", Json::array({argument("file", "file")})}},
         {{"name", "record-stop"}, {"usage", "record stop"}, {"meaning", "end"}, {"arguments", Json::array()}},
         {{"name", "equalizer-freeze"},
          {"usage", "equalizer NAME freeze FROZEN"},
          {"meaning", "freeze"},
          {"arguments", Json::array({argument("name", "text"), argument("frozen", "truth value")})}}});
}

// Returns the operation and its arguments, or the error.
std::string requested(const std::vector<std::string>& words) {
    auto request = requestOf(words, sampleOperations());
    return request ? request->operation + " " + jsonText(request->arguments) : request.error().message;
}

TEST(CommandWords, becomeRequests) {
    EXPECT_EQ(requested({"status"}), "status {}");
    EXPECT_EQ(requested({"log-level"}), "log-level {}");
    EXPECT_EQ(requested({"log-level", "rsp:debug"}), R"(log-level {"levels":"rsp:debug"})");
    EXPECT_EQ(requested({"remove-node", "1"}), R"(remove-node {"node":1})");
    EXPECT_EQ(requested({"remove-node", "1", "force"}), R"(remove-node {"force":true,"node":1})");
    EXPECT_EQ(requested({"equalizer", "set", "set", "damping", "0.5"}),
              R"(equalizer-set {"name":"set","parameter":"damping","value":"0.5"})");
    EXPECT_EQ(requested({"equalizer", "wall", "freeze", "off"}), R"(equalizer-freeze {"frozen":false,"name":"wall"})");
}

TEST(CommandWords, completePathsOfFiles) {
    const std::string here = std::filesystem::current_path().string();
    EXPECT_EQ(requested({"record", "start", "a.mural"}), R"(record-start {"file":")" + here + R"(/a.mural"})");
    EXPECT_EQ(requested({"record", "start", "./b/../a.mural"}), R"(record-start {"file":")" + here + R"(/a.mural"})");
    EXPECT_EQ(requested({"record", "start", "/tmp/a.mural"}), R"(record-start {"file":"/tmp/a.mural"})");
    EXPECT_EQ(requested({"record", "stop"}), "record-stop {}");
    EXPECT_NE(requested({"record", "start", ""}).find("must be a file"), std::string::npos);
}

TEST(CommandWords, nameTheUsageInErrors) {
    EXPECT_EQ(requested({"remove-node"}), "the argument node is missing; usage: mural ctl remove-node NODE [force]");
    EXPECT_EQ(requested({"remove-node", "one"}),
              "node must be a whole number instead of one; usage: mural ctl remove-node NODE [force]");
    EXPECT_EQ(requested({"remove-node", "1", "all"}), "unexpected word all; usage: mural ctl remove-node NODE [force]");
    EXPECT_EQ(requested({"status", "now"}), "unexpected word now; usage: mural ctl status");
    EXPECT_EQ(requested({"equalizer", "wall"}),
              "equalizer has other words; usage: mural ctl equalizer NAME set PARAMETER VALUE, or mural ctl equalizer "
              "NAME freeze FROZEN");
    EXPECT_EQ(requested({"equalizer", "wall", "freeze", "maybe"}),
              "frozen must be on or off instead of maybe; usage: mural ctl equalizer NAME freeze FROZEN");
}

TEST(CommandWords, nameSimilarOperations) {
    EXPECT_EQ(requested({"statsu"}), "no operation has the name \"statsu\"; similar names: status; help lists all");
    EXPECT_EQ(requested({"equaliser"}),
              "no operation has the name \"equaliser\"; similar names: equalizer; help lists all");
}

TEST(CommandWords, surviveMalformedOperations) {
    for (const char* text : {"null", "7", "[]", "[null]", "[{}]", R"([{"usage":7}])", R"([{"usage":"status [x] N"}])",
                             R"([{"usage":"status N","arguments":[7,{"name":1}]}])"})
        EXPECT_FALSE(requestOf({"status", "1", "2"}, parseJson(text)).ok()) << text;
}

TEST(CommandWords, nameASession) {
    for (const char* word : {"4711", "mural-4711-0123456789abcdef", "/run/user/1/mural-1-0/control"})
        EXPECT_TRUE(namesSession(word)) << word;
    for (const char* word : {"status", "mural-4711", "4711x", "", "./control"})
        EXPECT_FALSE(namesSession(word)) << word;
}

TEST(ReplyText, hasOneLinePerMember) {
    const Json result = {{"frames", 7},   {"seconds", 1.5}, {"delta", nullptr},
                         {"lost", false}, {"list", {1, 2}}, {"nodes", {{{"node", 0}, {"gl", "x"}}}}};
    EXPECT_EQ(replyLines("report", result),
              (std::vector<std::string>{"delta    none", "frames   7", "list  [1,2]", "lost     no", "nodes 0",
                                        "  gl    x", "  node  0", "seconds  1.5"}));
    EXPECT_TRUE(replyLines("stop", Json::object()).empty());
}

TEST(ReplyText, listsOperations) {
    const auto lines = replyLines("help", {{"operations", sampleOperations()}});
    ASSERT_EQ(lines.size(), sampleOperations().size());
    EXPECT_EQ(lines.back(), "status                              the state");
}

TEST(ReplyText, survivesMalformedResults) {
    for (const char* operation : {"status", "nodes", "help", "report"})
        for (const char* text :
             {"null", "7", "[]", R"({"nodes":7,"operations":8})", R"({"nodes":[7],"operations":[[]]})",
              R"({"a":[[[[{"b":{"c":[{"d":[{"e":{}}]}]}}]]]]})"})
            EXPECT_NO_THROW(replyLines(operation, parseJson(text))) << operation << text;
}

} // namespace
} // namespace mural::cli
