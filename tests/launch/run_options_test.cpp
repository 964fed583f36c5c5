// Parsing and checks of the options of mural run.
#include "tools/mural/run/run_options.hpp"

#include <gtest/gtest.h>

namespace mural::cli {
namespace {

RunArguments with(const std::function<void(RunArguments&)>& change) {
    RunArguments arguments;
    arguments.program = {"app", "-x"};
    change(arguments);
    return arguments;
}

RunOptions accepted(const std::function<void(RunArguments&)>& change) {
    auto options = runOptionsFrom(with(change));
    EXPECT_TRUE(options.ok()) << (options.ok() ? "" : options.error().message);
    return options.ok() ? options.value() : RunOptions{};
}

std::string refusal(const std::function<void(RunArguments&)>& change) {
    const auto options = runOptionsFrom(with(change));
    return options.ok() ? "accepted" : options.error().message;
}

TEST(RunOptions, defaultToOneExactNode) {
    const RunOptions o = accepted([](RunArguments&) {});
    EXPECT_EQ(o.config.columns, 1);
    EXPECT_EQ(o.config.rows, 1);
    EXPECT_EQ(o.config.tiling, Tiling::Exact);
    EXPECT_EQ(o.config.latency, 1);
    EXPECT_FALSE(o.displayChosen);
    EXPECT_EQ(o.program, (std::vector<std::string>{"app", "-x"}));
}

TEST(RunOptions, needNoTilesForAQueue) {
    const RunOptions o = accepted([](RunArguments& a) {
        a.tileQueue = "64x48";
        a.localNodes = "5";
    });
    EXPECT_EQ(o.config.tileWidth, 64);
    EXPECT_EQ(o.config.tileHeight, 48);
    EXPECT_EQ(o.config.columns * o.config.rows, 1);
    const RunOptions printed = accepted([](RunArguments& a) {
        a.tileQueue = "64x48";
        a.localNodes = "2";
        a.printConfig = true;
    });
    EXPECT_NE(printed.configText.find("outputtiles { name \"wall.queue\" size [ 64 48 ] }"), std::string::npos)
        << printed.configText;
}

TEST(RunOptions, readEveryOption) {
    const RunOptions o = accepted([](RunArguments& a) {
        a.tiles = "7x5";
        a.nodes = "h1,h2";
        a.localNodes = "3";
        a.size = "7680x4320";
        a.frames = "90";
        a.out = "shots";
        a.save = "90,1,30,30";
        a.display = "windows";
        a.tiling = "lean";
        a.localRendering = "on";
        a.gl = "osmesa";
        a.gpus = "first";
        a.latency = "0";
        a.captureVia = "preload";
        a.verify = "5";
        a.fullScreen = true;
        a.position = "-10,20";
        a.noPlacement = true;
        a.overlay = "grid";
        a.overlayInFiles = true;
        a.launch = "rsh";
        a.remoteMural = "/opt/mural";
        a.delta = "off";
        a.cacheSize = "64MiB";
    });
    const SessionConfig& c = o.config;
    EXPECT_EQ(c.columns, 7);
    EXPECT_EQ(c.rows, 5);
    EXPECT_EQ(c.hosts, (std::vector<std::string>{"h1", "h2"}));
    EXPECT_EQ(c.localNodes, 3);
    EXPECT_EQ(c.width, 7680);
    EXPECT_EQ(c.height, 4320);
    EXPECT_EQ(c.frames, 90);
    EXPECT_EQ(c.out, "shots");
    EXPECT_EQ(c.saveFrames, (std::vector<int64_t>{1, 30, 90}));
    EXPECT_EQ(c.display, Display::Windows);
    EXPECT_EQ(c.tiling, Tiling::Lean);
    EXPECT_EQ(c.localRendering, LocalRendering::On);
    EXPECT_EQ(c.glBackend, "osmesa");
    EXPECT_EQ(c.gpus, std::vector<std::string>{"first"});
    EXPECT_EQ(c.latency, 0);
    EXPECT_EQ(c.verifyEvery, 5);
    EXPECT_TRUE(c.fullScreen);
    EXPECT_EQ(c.windowX, -10);
    EXPECT_EQ(c.windowY, 20);
    EXPECT_FALSE(c.placeThreads);
    EXPECT_EQ(c.overlay, OverlayMode::Grid);
    EXPECT_TRUE(c.overlayInFiles);
    EXPECT_EQ(c.launchCommand, "rsh");
    EXPECT_EQ(c.remoteMural, "/opt/mural");
    EXPECT_EQ(c.delta, DeltaMode::Off);
    EXPECT_EQ(c.cacheBytes, 64 << 20);
    EXPECT_EQ(o.captureVia, EntryChoice::Preload);
}

TEST(RunOptions, nameGpusInAList) {
    const RunOptions o = accepted([](RunArguments& a) { a.gpus = "0000:65:00.0,GPU-1f,2"; });
    EXPECT_EQ(o.config.gpus, (std::vector<std::string>{"0000:65:00.0", "GPU-1f", "2"}));
    for (const char* bad : {"", "1,,2", "auto,1", "1,first", ","})
        EXPECT_EQ(
            refusal([&](RunArguments& a) { a.gpus = bad; }).rfind("--gpus \"" + std::string(bad) + "\": must be", 0),
            0u)
            << bad;
    EXPECT_EQ(refusal([](RunArguments& a) { a.gl = "osmesa", a.gpus = "1"; }), "--gpus 1 needs EGL; omit --gl osmesa");
}

TEST(RunOptions, giveNodesOneTileEachByDefault) {
    const auto grid = [](const char* local) {
        const RunOptions o = accepted([&](RunArguments& a) { a.localNodes = local; });
        return std::pair(o.config.columns, o.config.rows);
    };
    EXPECT_EQ(grid("1"), std::pair(1, 1));
    EXPECT_EQ(grid("4"), std::pair(2, 2));
    EXPECT_EQ(grid("6"), std::pair(3, 2));
    EXPECT_EQ(grid("7"), std::pair(7, 1));
    const RunOptions o = accepted([](RunArguments& a) { a.nodes = "a,b"; });
    EXPECT_EQ(o.config.columns, 2);
}

TEST(RunOptions, nameTheOptionAndTheExpectedValue) {
    for (const char* bad : {"2", "2x", "x2", "0x1", "2x2x2", "-1x2", "2 x2", "2X2", "257x1", "99999999999x1", ""}) {
        EXPECT_EQ(
            refusal([&](RunArguments& a) { a.tiles = bad; }).rfind("--tiles \"" + std::string(bad) + "\": must be", 0),
            0u)
            << bad;
    }
    EXPECT_NE(refusal([](RunArguments& a) { a.size = "32768x1"; }).find("32767"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.frames = "0"; }).find("--frames"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.latency = "-1"; }).find("--latency"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.overlay = "on"; }).find("off, stats, names or grid"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.overlayInFiles = true; }).find("--out"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.verify = "0"; }).find("--verify"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.gl = "vulkan"; }).find("auto, egl, osmesa, glx"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.captureVia = "both"; }).find("auto, glvnd, preload"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.delta = "yes"; }).find("auto, on, off"), std::string::npos);
    for (const char* bad : {"", "GiB", "1GB", "-1MiB", "1023KiB", "1025GiB", "9223372036854775807GiB", "1 GiB"})
        EXPECT_NE(refusal([&](RunArguments& a) { a.cacheSize = bad; }).find("--cache-size"), std::string::npos) << bad;
    EXPECT_EQ(accepted([](RunArguments& a) { a.cacheSize = "1048576"; }).config.cacheBytes, 1 << 20);
    EXPECT_NE(refusal([](RunArguments& a) { a.position = "1"; }).find("--position"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.nodes = "h1,-oProxyCommand=x"; }).find("--nodes"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.nodes = "3"; }).find("--local-nodes"), std::string::npos)
        << "a number is hardly a host";
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.nodes = "h1,h2", a.minNodes = "3";
              }).find("--min-nodes \"3\": must be at most 2"),
              std::string::npos);
}

TEST(RunOptions, readPasses) {
    const RunOptions o = accepted([](RunArguments& a) {
        a.stereo = "anaglyph";
        a.eyeBase = "0.25";
        a.focus = "40";
        a.pixel = "3x2";
        a.subpixel = "4";
        a.dplex = "5";
    });
    const PassCounts& p = o.config.passes;
    EXPECT_EQ(p.stereo, StereoMode::Anaglyph);
    EXPECT_EQ(o.config.eyeBase, 0.25);
    EXPECT_EQ(o.config.focusDistance, 40);
    EXPECT_EQ(std::pair(p.kernelWidth, p.kernelHeight), std::pair(3, 2));
    EXPECT_EQ(p.samples, 4);
    EXPECT_EQ(p.period, 5);
    EXPECT_EQ(o.config.latency, 5) << "turns overlap only so";
    EXPECT_EQ(accepted([](RunArguments& a) {
                  a.dplex = "3";
                  a.latency = "1";
              }).config.latency,
              1);
    const PassCounts row = accepted([](RunArguments& a) { a.pixel = "5"; }).config.passes;
    EXPECT_EQ(std::pair(row.kernelWidth, row.kernelHeight), std::pair(5, 1));
    EXPECT_TRUE(p.zoom.none());
    EXPECT_EQ(accepted([](RunArguments& a) { a.zoom = "0.5"; }).config.passes.zoom, (Zoom{0.5, 0.5}));
    EXPECT_EQ(accepted([](RunArguments& a) {
                  a.zoom = "2x0.25";
                  a.db = "2";
              }).config.passes.zoom,
              (Zoom{2, 0.25}));
    const char* const modes[] = {"off", "anaglyph", "side-by-side", "top-bottom", "left", "right", "quad"};
    for (size_t i = 0; i < 7; ++i)
        EXPECT_EQ(accepted([&](RunArguments& a) { a.stereo = modes[i]; }).config.passes.stereo,
                  static_cast<StereoMode>(i));
}

TEST(RunOptions, allowCompositionOnlyForSharedDraws) {
    EXPECT_EQ(accepted([](RunArguments& a) { a.db = "3"; }).config.composition, "auto");
    for (const char* how : {"auto", "serial", "direct-send", "binary-swap", "2-3-swap", "radix-k", "streaming"})
        EXPECT_EQ(accepted([&](RunArguments& a) {
                      a.db = "3";
                      a.composition = how;
                  }).config.composition,
                  how);
    EXPECT_EQ(
        refusal([](RunArguments& a) {
            a.db = "3";
            a.composition = "swap";
        }),
        "--composition \"swap\": must be one of auto, serial, direct-send, binary-swap, 2-3-swap, radix-k, streaming");
    EXPECT_EQ(refusal([](RunArguments& a) { a.composition = "serial"; }),
              "--composition requires sort-last nodes; add --db N, such as --db 4");
}

TEST(RunOptions, shareTilesAmongNodesOfSeveralPasses) {
    EXPECT_EQ(accepted([](RunArguments& a) {
                  a.subpixel = "4";
                  a.localNodes = "4";
              }).config.columns,
              1);
    const RunOptions o = accepted([](RunArguments& a) {
        a.subpixel = "2";
        a.localNodes = "8";
    });
    EXPECT_EQ(std::pair(o.config.columns, o.config.rows), std::pair(2, 2));
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.subpixel = "2";
                  a.tiles = "2x1";
                  a.localNodes = "5";
              }).find("5 render nodes for 2 tiles in 2 passes"),
              std::string::npos);
}

TEST(RunOptions, nameTheOptionAndTheExpectedValueOfPasses) {
    const auto names = [](const char* option, auto change) {
        const std::string message = refusal(change);
        EXPECT_EQ(message.rfind(option, 0), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    };
    for (const char* bad : {"0", "17", "-1", "nan", "inf", "0.5x", "x2", "1x2x3", "half", ""})
        names("--zoom \"", [&](RunArguments& a) { a.zoom = bad; });
    for (const char* bad : {"0", "17", "2x17", "0x2", "x", "2x", ""})
        names("--pixel \"", [&](RunArguments& a) { a.pixel = bad; });
    for (const char* bad : {"0", "257", "-1", "2.5", ""}) {
        names("--subpixel", [&](RunArguments& a) { a.subpixel = bad; });
        names("--dplex", [&](RunArguments& a) { a.dplex = bad; });
    }
    names("--stereo", [](RunArguments& a) { a.stereo = "both"; });
    for (const char* bad : {"-1", "nan", "inf", "1e10", "wide", "1 ", ""})
        names("--eye-base", [&](RunArguments& a) {
            a.stereo = "left";
            a.eyeBase = bad;
        });
    for (const char* bad : {"0", "-3", "nan", "far"})
        names("--focus", [&](RunArguments& a) {
            a.stereo = "left";
            a.focus = bad;
        });
    names("--projection requires a configuration file", [](RunArguments& a) { a.projection = "room"; });
    names("--projection", [](RunArguments& a) {
        a.config = std::string(MURAL_SOURCE_DIR) + "/configs/cave.eqc";
        a.projection = "cave";
    });
    names("--model-unit", [](RunArguments& a) {
        a.config = std::string(MURAL_SOURCE_DIR) + "/configs/cave.eqc";
        a.modelUnit = "0";
    });
    names("--eye-base requires stereo", [](RunArguments& a) { a.eyeBase = "1"; });
    names("--focus requires stereo", [](RunArguments& a) { a.focus = "1"; });
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.subpixel = "16";
                  a.pixel = "4x4";
                  a.stereo = "anaglyph";
              }).find("512 passes together; the maximum is 256"),
              std::string::npos);
    names("--verify compares with", [](RunArguments& a) {
        a.subpixel = "2";
        a.verify = "1";
    });
    names("--verify compares with", [](RunArguments& a) {
        a.zoom = "2";
        a.verify = "1";
    });
    names("--tiling lean does not support --zoom", [](RunArguments& a) {
        a.zoom = "2";
        a.tiling = "lean";
    });
    EXPECT_EQ(accepted([](RunArguments& a) {
                  a.dplex = "2";
                  a.verify = "1";
              }).config.verifyEvery,
              1);
    names("--tiling lean does not support", [](RunArguments& a) {
        a.subpixel = "2";
        a.tiling = "lean";
    });
}

TEST(RunOptions, rejectMeaninglessCombinations) {
    EXPECT_NE(refusal([](RunArguments& a) { a.save = "1"; }).find("--out"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.fullScreen = true; }).find("--display windows"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.native = true;
                  a.out = "x";
              }).find("--native"),
              std::string::npos);
    EXPECT_EQ(refusal([](RunArguments& a) {
                  a.native = true;
                  a.record = "x";
              }),
              "--record requires captured frames; omit --native");
    EXPECT_NE(refusal([](RunArguments& a) { a.record = ""; }).find("--record"), std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.tiles = "2x2";
                  a.localNodes = "5";
              }).find("5 render nodes for 4 tiles"),
              std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.tiles = "2x2";
                  a.tileQueue = "32x32";
              }).find("omit one of them"),
              std::string::npos);
    for (const char* bad : {"", "1", "5000", "x", "-3", "2.5"})
        EXPECT_EQ(refusal([&](RunArguments& a) {
                      a.db = "2";
                      a.chunkQueue = bad;
                  }).rfind("--chunk-queue", 0),
                  0u)
            << bad;
    EXPECT_NE(refusal([](RunArguments& a) { a.chunkQueue = "20"; }).find("add --db"), std::string::npos);
    EXPECT_EQ(accepted([](RunArguments& a) {
                  a.db = "2";
                  a.chunkQueue = "20";
              }).config.chunks,
              20);
    for (const char* bad : {"", "32", "0x32", "32x", "axb", "-1x3"})
        EXPECT_EQ(refusal([&](RunArguments& a) {
                      a.tileQueue = bad;
                  }).rfind("--tile-queue \"" + std::string(bad) + "\": must be", 0),
                  0u)
            << bad;
    EXPECT_NE(refusal([](RunArguments& a) {
                  a.tiles = "4x4";
                  a.size = "3x100";
              }).find("do not fit"),
              std::string::npos);
    EXPECT_NE(refusal([](RunArguments& a) { a.program.clear(); }).find("no program"), std::string::npos);
}

} // namespace
} // namespace mural::cli
