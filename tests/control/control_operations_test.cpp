// The table of operations: checks of arguments, errors, descriptions; the operations of equalizers.
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_operations.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "nodes/head/control/equalizer_operations.hpp"
#include "nodes/head/control/nearest_names.hpp"
#include "tests/control/sample_operations.hpp"

namespace mural {
namespace {

using Json = nlohmann::json;

std::string codeOf(const ControlOperations& operations, const char* name, const char* arguments) {
    Json result;
    return operations.perform(name, parseJson(arguments), result).code;
}

TEST(ControlOperations, acceptArgumentsOfTheDescribedTypes) {
    const ControlOperations all = sampleOperations();
    Json result;
    const Json arguments = {{"whole", -3}, {"text", "a"}, {"truth", true}, {"scalar", 0.5}};
    EXPECT_EQ(all.perform("echo", arguments, result).code, "");
    EXPECT_EQ(result, arguments);
    EXPECT_EQ(codeOf(all, "echo", "{}"), "");
}

TEST(ControlOperations, rejectOtherArguments) {
    const ControlOperations all = sampleOperations();
    for (const char* arguments : {R"({"whole":1.5})", R"({"whole":"1"})", R"({"whole":18446744073709551615})",
                                  R"({"text":1})", R"({"text":null})", R"({"truth":1})", R"({"scalar":[1]})",
                                  R"({"scalar":{}})", R"({"other":1})", R"([])", R"("x")", R"(null)"})
        EXPECT_EQ(codeOf(all, "echo", arguments), "bad-argument") << arguments;
    EXPECT_EQ(codeOf(all, "restart-node", "{}"), "bad-argument");
    EXPECT_EQ(codeOf(all, "restart-node", R"({"node":2})"), "failed");
    EXPECT_EQ(codeOf(all, "none", "{}"), "unknown-operation");
}

TEST(ControlOperations, nameTheArgumentAndTheUsage) {
    Json result;
    const ControlError error = sampleOperations().perform("restart-node", {{"node", "one"}}, result);
    EXPECT_EQ(error.text, "restart-node: node is not a whole number; usage: restart-node NODE");
}

TEST(ControlOperations, nameSimilarOperations) {
    EXPECT_EQ(unknownOperation("statsu", {"help", "status", "stop"}).text,
              "no operation has the name \"statsu\"; similar names: status; help lists all");
    EXPECT_EQ(unknownOperation("zebra", {"help", "status"}).text,
              "no operation has the name \"zebra\"; help lists all");
    EXPECT_LT(unknownOperation(std::string(60'000, 'x'), {"help"}).text.size(), 200U);
}

TEST(NearestNames, areOrderedBySimilarity) {
    const std::vector<std::string> names = {"equalizer-set", "equalizers", "nodes", "stop"};
    EXPECT_EQ(nearestNames("equalizer", names), (std::vector<std::string>{"equalizers", "equalizer-set"}));
    EXPECT_EQ(nearestNames("node", names), (std::vector<std::string>{"nodes"}));
    EXPECT_EQ(nearestNames("", names), std::vector<std::string>());
    EXPECT_EQ(nearestNames("frobnicate", names), std::vector<std::string>());
}

TEST(ControlOperations, describeThemselves) {
    Json list = Json::array();
    sampleOperations().describe(list);
    ASSERT_EQ(list.size(), 3U);
    EXPECT_EQ(list[0]["name"], "echo");
    EXPECT_EQ(list[0]["usage"], "echo [WHOLE] [TEXT] [truth] [SCALAR]");
    EXPECT_EQ(list[1]["arguments"][0],
              Json({{"name", "node"}, {"kind", "whole number"}, {"required", true}, {"meaning", ""}}));
}

class FakeEqualizers : public EqualizerControl {
public:
    [[nodiscard]] Json list() const override { return {{{"name", "wall"}, {"frozen", isFrozen}}}; }
    Result<void> set(const std::string& name, const std::string& parameter, const std::string& value) override {
        if (name != "wall") return Error{"no equalizer has the name " + name};
        was = parameter + "=" + value;
        return {};
    }
    Result<void> freeze(const std::string&, bool isFrozenNow) override {
        isFrozen = isFrozenNow;
        return {};
    }
    bool isFrozen = false;
    std::string was;
};

TEST(EqualizerOperations, listSetAndFreeze) {
    FakeEqualizers equalizers;
    ControlOperations all;
    addEqualizerOperations(all, equalizers);
    EXPECT_EQ(codeOf(all, "equalizer-set", R"({"name":"wall","parameter":"damping","value":0.5})"), "");
    EXPECT_EQ(equalizers.was, "damping=0.5");
    EXPECT_EQ(codeOf(all, "equalizer-set", R"({"name":"wall","parameter":"mode","value":"horizontal"})"), "");
    EXPECT_EQ(equalizers.was, "mode=horizontal");
    EXPECT_EQ(codeOf(all, "equalizer-set", R"({"name":"other","parameter":"mode","value":true})"), "failed");
    EXPECT_EQ(codeOf(all, "equalizer-freeze", R"({"name":"wall","frozen":true})"), "");
    Json result;
    EXPECT_EQ(all.perform("equalizers", Json::object(), result).code, "");
    EXPECT_EQ(result, parseJson(R"({"equalizers":[{"name":"wall","frozen":true}]})"));
}

} // namespace
} // namespace mural
