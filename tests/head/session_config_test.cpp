// Session and node configurations as JSON: round trips, defaults, errors.
#include "nodes/session/session_config.hpp"
#include "nodes/session/session_secret.hpp"

#include <gtest/gtest.h>

namespace mural {
namespace {

TEST(SessionConfig, roundTripsEveryField) {
    SessionConfig c;
    c.session = "mural-7";
    c.columns = 3;
    c.rows = 5;
    c.localNodes = 2;
    c.hosts = {"a", "b c"};
    c.launchCommand = "rsh";
    c.remoteMural = "/opt/mural";
    c.tiling = Tiling::Lean;
    c.display = Display::App;
    c.localRendering = LocalRendering::On;
    c.glBackend = "osmesa";
    c.latency = 0;
    c.verifyEvery = 4;
    c.frames = int64_t{1} << 40;
    c.out = "out \"quoted\"";
    c.saveFrames = {1, 30, 90};
    c.sends = {"museum=wall.example:4281,codec=auto"};
    c.width = 640;
    c.height = 480;
    c.fullScreen = true;
    c.windowX = -10;
    c.windowY = 20;
    c.placeThreads = false;
    c.overlay = OverlayMode::Names;
    c.overlayInFiles = true;
    c.windowInput = input::InputPermission::Any;
    c.explain = true;
    c.displayName = ":7";
    const std::string json = toJson(c);
    EXPECT_EQ(json.find('\n'), std::string::npos);
    auto back = sessionConfigFromJson(json);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(toJson(*back), json);
    EXPECT_EQ(back.value().saveFrames, c.saveFrames);
    EXPECT_EQ(back.value().sends, c.sends);
    EXPECT_EQ(back.value().hosts, c.hosts);
    EXPECT_EQ(back.value().display, Display::App);
    EXPECT_EQ(back.value().overlay, OverlayMode::Names);
    EXPECT_EQ(back.value().windowInput, input::InputPermission::Any);
    EXPECT_NE(json, toJson(SessionConfig{}));
}

TEST(SessionConfig, roundTripsPasses) {
    SessionConfig c;
    c.passes = {StereoMode::TopBottom, 3, 2, 4, 5};
    c.eyeBase = 0.0625;
    c.focusDistance = 1e6;
    auto back = sessionConfigFromJson(toJson(c));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(toJson(*back), toJson(c));
    EXPECT_EQ(passesOf((*back).passes), passesOf(c.passes));
    EXPECT_EQ((*back).eyeBase, 0.0625);
    EXPECT_EQ((*back).focusDistance, 1e6);
}

TEST(SessionConfig, rejectsForeignPasses) {
    NodeSetup setup;
    setup.pass = {Eye::Right, 1, 2, 2, 3, 0, 4, 1, 2, 0, 1, {}, {}};
    ASSERT_TRUE(nodeSetupFromJson(toJson(setup)).ok());
    const auto refused = [&](auto change) {
        NodeSetup bad = setup;
        change(bad.pass);
        return !nodeSetupFromJson(toJson(bad)).ok();
    };
    EXPECT_TRUE(refused([](RenderPass& p) { p.kernelX = 2; }));
    EXPECT_TRUE(refused([](RenderPass& p) { p.kernelY = 3; }));
    EXPECT_TRUE(refused([](RenderPass& p) { p.sample = 4; }));
    EXPECT_TRUE(refused([](RenderPass& p) { p.phase = 2; }));
    EXPECT_TRUE(refused([](RenderPass& p) { p.samples = 0; }));
    EXPECT_TRUE(refused([](RenderPass& p) { p.kernelX = -1; }));
}

TEST(SessionConfig, usesDefaultsForMissingFields) {
    const auto c = sessionConfigFromJson(R"({"session":"s"})");
    ASSERT_TRUE(c.ok());
    EXPECT_EQ(c.value().latency, 1);
    EXPECT_EQ(c.value().launchCommand, "ssh");
}

TEST(NodeSetup, limitsZooms) {
    NodeSetup setup;
    setup.pass.zoom = {0.3, 16};
    const auto read = nodeSetupFromJson(toJson(setup));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read.value().pass.zoom, setup.pass.zoom);
    for (const double bad : {0.0, -0.5, 16.01}) {
        setup.pass.zoom.y = bad;
        EXPECT_FALSE(nodeSetupFromJson(toJson(setup)).ok()) << bad;
    }
}

TEST(SessionConfig, storesZoomsPerNode) {
    SessionConfig config;
    config.passes.zoom = {0.3, 16};
    const auto read = sessionConfigFromJson(toJson(config));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read.value().passes.zoom, config.passes.zoom);
    for (const RenderPass& p : passesOf(read.value().passes)) EXPECT_EQ(p.zoom, config.passes.zoom);
    config.passes.zoom.x = 0;
    EXPECT_FALSE(sessionConfigFromJson(toJson(config)).ok());
}

TEST(SessionConfig, namesTheFieldInErrors) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"colums":2})", "colums"},
        {R"({"columns":"2"})", "columns"},
        {R"({"columns":0})", "columns"},
        {R"({"stereo":"both"})", "stereo"},
        {R"({"samples":0})", "samples"},
        {R"({"kernelWidth":-1})", "kernelWidth"},
        {R"({"period":"2"})", "period"},
        {R"({"eyeBase":"wide"})", "eyeBase"},
        {R"({"projection":"cave"})", "auto program room"},
        {R"({"columns":2.5})", "columns"},
        {R"({"columns":4294967296})", "columns"},
        {R"({"frames":18446744073709551615})", "frames"},
        {R"({"tiling":"rough"})", "exact culled lean"},
        {R"({"hosts":["a",1]})", "hosts"},
        {R"({"saveFrames":[0]})", "saveFrames"},
        {R"({"fullScreen":1})", "fullScreen"},
        {R"([1])", "not a JSON object"},
        {R"({"columns":)", "not a JSON object"},
        {"", "not a JSON object"},
    };
    for (const auto& [json, part] : cases) {
        const auto c = sessionConfigFromJson(json);
        ASSERT_FALSE(c.ok()) << json;
        EXPECT_NE(c.error().message.find(part), std::string::npos) << c.error().message;
        EXPECT_EQ(c.error().message.find('\n'), std::string::npos);
    }
}

TEST(NodeSetup, roundTripsAndChecksRegions) {
    NodeSetup s;
    s.node = 2;
    s.nodeCount = 3;
    s.columns = 4;
    s.rows = 2;
    s.regionColumn = 2;
    s.regionColumns = 2;
    s.regionRows = 2;
    s.sendPictures = true;
    auto back = nodeSetupFromJson(toJson(s));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(toJson(*back), toJson(s));
    s.regionColumn = 3;
    EXPECT_FALSE(nodeSetupFromJson(toJson(s)).ok());
}

TEST(SessionSecret, roundTripsAsHex) {
    auto a = makeSessionSecret();
    auto b = makeSessionSecret();
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_NE(*a, *b);
    auto back = sessionSecretFromHex(toHex(*a) + "\n");
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(*a, *back);
    EXPECT_FALSE(sessionSecretFromHex(toHex(*a).substr(1)).ok());
    EXPECT_FALSE(sessionSecretFromHex(std::string(64, 'g')).ok());
}

} // namespace
} // namespace mural
