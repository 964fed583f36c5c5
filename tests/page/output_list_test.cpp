#include "tools/mural/page/hub/output_list.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mural::page {
namespace {

using Json = nlohmann::json;

Json segment(const char* name, const Json& node, const Json& rect) {
    return {{"name", name}, {"node", node}, {"rectPx", rect}};
}

const Json kWall = {
    {"canvases",
     {{{"name", "front"},
       {"sizePx", {200, 100}},
       {"segments",
        {segment("left", 0, {0, 0, 100, 100}), segment("right", 1, {100, 0, 100, 50}),
         segment("none", nullptr, {0, 0, 1, 1})}}},
      {{"name", "side"}, {"sizePx", {100, 100}}, {"segments", {segment("left", 2, {0, 0, 100, 100})}}}}}};

Json proof(int node, const Json& hash) {
    return {{"node", node}, {"frame", 70 + node}, {"hash", hash}, {"ageSeconds", 0.5}, {"skewMs", nullptr}};
}

TEST(OutputList, describesAreasAsFractionsOfTheFirstCanvas) {
    const Json areas = areasOf(kWall);
    EXPECT_EQ(areas.size(), 3u);
    EXPECT_EQ(areas["front/right"], Json({0.5, 0.0, 0.5, 0.5}));
    EXPECT_TRUE(areasOf(Json::object()).empty());
    EXPECT_TRUE(areasOf({{"canvases", {{{"name", "x"}, {"sizePx", {0, 0}}, {"segments", Json::array()}}}}}).empty());
}

TEST(OutputList, provesSegmentsWithoutWindowsByTheHeadsPicture) {
    const Json proofs = {{"frame", 12},
                         {"areas", {{"front/left", "aa"}, {"front/right", "bb"}}},
                         {"nodes", {proof(0, nullptr), proof(1, nullptr), proof(2, nullptr)}}};
    const Json list = outputList(kWall, proofs);
    ASSERT_EQ(list.size(), 2u); // nobody has the picture of the canvas "side"
    EXPECT_EQ(list[0]["hash"], "aa");
    EXPECT_EQ(list[0]["frame"], 12);
    EXPECT_EQ(list[1]["output"], "right");
    EXPECT_EQ(list[1]["node"], 1);
}

TEST(OutputList, prefersWindowsOfNodesToTheHeadsPicture) {
    const Json proofs = {{"frame", 12}, {"areas", {{"front/left", "aa"}}}, {"nodes", {proof(0, "cc"), proof(2, "dd")}}};
    const Json list = outputList(kWall, proofs);
    ASSERT_EQ(list.size(), 2u); // node 1 has proved nothing yet
    EXPECT_EQ(list[0]["hash"], "cc");
    EXPECT_EQ(list[0]["frame"], 70);
    EXPECT_EQ(list[1]["canvas"], "side");
    EXPECT_EQ(list[1]["hash"], "dd");
}

} // namespace
} // namespace mural::page
