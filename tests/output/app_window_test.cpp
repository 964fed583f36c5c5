// Pictures in the program's own window, read back from X servers of several depths.
#include "nodes/output/windows/app_window.hpp"

#include <csignal>
#include <cstring>

#include "tests/output/test_pictures.hpp"
#include "tests/output/xvfb_server.hpp"

namespace mural::test {

namespace {

constexpr uint32_t kBlue = 0x0000ff;

// A server, a client with eyes, and the window that pictures are shown in.
class AppWindows : public testing::Test {
protected:
    void SetUp() override { std::signal(SIGPIPE, SIG_IGN); } // as head and nodes do: servers end here

    void startServer(int depth = 24, const std::vector<std::string>& options = {}) {
        auto server = XvfbServer::start(700, 500, depth, options);
        ASSERT_TRUE(server) << server.error().message;
        server_ = std::move(server.value());
        auto client = XClient::open(server_->displayName());
        ASSERT_TRUE(client) << client.error().message;
        client_ = std::move(client.value());
    }

    AppWindowConfig configFor(uint32_t window, bool sharedMemory = true) {
        AppWindowConfig config;
        config.displayName = server_->displayName();
        config.window = window;
        config.sharedMemory = sharedMemory;
        return config;
    }

    void openOutput(const AppWindowConfig& config) {
        auto output = AppWindow::open(config);
        ASSERT_TRUE(output) << output.error().message;
        output_ = std::move(output.value());
    }

    void show(const OwnedPicture& picture) {
        Result<void> shown = output_->show(++frame_, picture.view());
        ASSERT_TRUE(shown) << shown.error().message;
    }

    void expectSeen(uint32_t window, int x, int y, const Picture& expected) {
        auto seen = client_->see(window, x, y, expected.width, expected.height);
        ASSERT_TRUE(seen) << seen.error().message;
        EXPECT_TRUE(samePictures(expected, seen->view()));
    }

    std::unique_ptr<XvfbServer> server_;
    std::unique_ptr<XClient> client_;
    std::unique_ptr<AppWindow> output_;
    int64_t frame_ = 0;
};

} // namespace

TEST_F(AppWindows, showExactlyThroughSharedMemory) {
    startServer();
    const uint32_t window = client_->makeWindow(10, 20, 301, 203, kBlue);
    openOutput(configFor(window));
    for (uint32_t i = 0; i < 3; ++i) {
        const OwnedPicture picture = noisePicture(301, 203, i);
        show(picture);
        EXPECT_TRUE(output_->usesSharedMemory());
        expectSeen(window, 0, 0, picture.view());
    }
}

TEST_F(AppWindows, showExactlyThroughTheConnection) {
    startServer();
    const uint32_t window = client_->makeWindow(10, 20, 301, 203, kBlue);
    // The last ones are so small that rows are cut too.
    for (const size_t pieceBytes : {32'768, 1 << 20, 1204, 500, 1}) {
        AppWindowConfig config = configFor(window, false);
        config.pieceBytes = pieceBytes;
        if (pieceBytes == 1) client_->resizeWindow(window, 20, 20);
        openOutput(config);
        const int width = pieceBytes == 1 ? 20 : 301;
        const int height = pieceBytes == 1 ? 20 : 203;
        const OwnedPicture picture = noisePicture(width, height, static_cast<uint32_t>(pieceBytes));
        show(picture);
        EXPECT_FALSE(output_->usesSharedMemory());
        expectSeen(window, 0, 0, picture.view());
    }
}

TEST_F(AppWindows, showWithoutSharedMemory) {
    startServer(24, {"-extension", "MIT-SHM"});
    const uint32_t window = client_->makeWindow(0, 0, 301, 203, kBlue);
    openOutput(configFor(window));
    const OwnedPicture picture = noisePicture(301, 203, 1);
    show(picture);
    EXPECT_FALSE(output_->usesSharedMemory());
    expectSeen(window, 0, 0, picture.view());
}

TEST_F(AppWindows, showAlphaInWindowsWithAlpha) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 64, 32, 0, 32);
    openOutput(configFor(window));
    const OwnedPicture picture = noisePicture(64, 32, 1);
    show(picture);
    expectSeen(window, 0, 0, picture.view());
    for (int x = 0; x < 64; ++x) {
        uint32_t expected = 0;
        std::memcpy(&expected, picture.view().row(26) + x * 4, 4);
        EXPECT_EQ(client_->pixelAt(window, x, 5).value(), expected);
    }
}

class OtherDepths : public AppWindows, public testing::WithParamInterface<bool> {};

// Width odd: rows are padded.
TEST_P(OtherDepths, supportSixteenBits) {
    startServer(16);
    const uint32_t window = client_->makeWindow(0, 0, 33, 9, 0);
    openOutput(configFor(window, GetParam()));
    const OwnedPicture picture = noisePicture(33, 9, 1);
    show(picture);
    auto converter = PixelConverter::make({16, 16, 32, 0xf800, 0x07e0, 0x001f});
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 33; ++x) {
            uint16_t expected = 0;
            converter->convertRow(PictureFormat::Bgra8, picture.view().row(8 - y) + x * 4, 1,
                                  reinterpret_cast<std::byte*>(&expected));
            ASSERT_EQ(client_->pixelAt(window, x, y).value() & 0xffff, expected) << x << ' ' << y;
        }
}

TEST_P(OtherDepths, supportThirtyBits) {
    startServer(30);
    const uint32_t window = client_->makeWindow(0, 0, 33, 9, 0);
    openOutput(configFor(window, GetParam()));
    OwnedPicture picture = plainPicture(33, 9, 255, 0, 0);
    setPixel(picture, 4, 8, 0, 255, 128);
    show(picture);
    const auto red = client_->pixelAt(window, 3, 0).value() & 0x3fffffffU;
    EXPECT_TRUE(red == 0x3ff00000U || red == 0x3ffU) << std::hex << red; // R first or B first
    const uint32_t half = (128 * 1023 + 127) / 255;
    const auto mixed = client_->pixelAt(window, 4, 0).value() & 0x3fffffffU;
    EXPECT_EQ(mixed, red == 0x3ffU ? (half << 20 | 1023U << 10) : (half | 1023U << 10));
}

TEST_P(OtherDepths, supportDeepPicturesAtThirtyBits) {
    startServer(30);
    const uint32_t window = client_->makeWindow(0, 0, 33, 9, 0);
    openOutput(configFor(window, GetParam()));
    OwnedPicture picture;
    picture.resize(33, 9, PictureFormat::Bgr10A2);
    const uint32_t word = 0x2aaU << 20 | 0x155U << 10 | 0x3feU;
    for (int i = 0; i < 33 * 9; ++i) std::memcpy(picture.data() + i * 4, &word, 4);
    show(picture);
    const auto seen = client_->pixelAt(window, 3, 0).value() & 0x3fffffffU;
    EXPECT_TRUE(seen == word || seen == (0x3feU << 20 | 0x155U << 10 | 0x2aaU)) << std::hex << seen;
}

INSTANTIATE_TEST_SUITE_P(Ways, OtherDepths, testing::Bool(),
                         [](const auto& shared) { return shared.param ? "sharedMemory" : "connection"; });

TEST_F(AppWindows, acceptPicturesOfOtherSizes) {
    startServer();
    const uint32_t window = client_->makeWindow(100, 100, 80, 60, kBlue);
    openOutput(configFor(window));
    const OwnedPicture larger = noisePicture(200, 90, 1);
    show(larger);
    // Upper left corners together, the rest clipped at the window's edges.
    expectSeen(window, 0, 0, cutOut(larger.view(), {0, 30, 80, 60}).view());
    auto besides = client_->seeScreen(180, 100, 1, 1);
    ASSERT_TRUE(besides);
    EXPECT_TRUE(samePictures(plainPicture(1, 1, 0, 0, 0).view(), besides->view()));
    const OwnedPicture smaller = noisePicture(50, 40, 2);
    show(smaller);
    expectSeen(window, 0, 0, smaller.view());
    expectSeen(window, 0, 40, cutOut(larger.view(), {0, 30, 80, 20}).view());
    client_->resizeWindow(window, 200, 90);
    show(larger);
    expectSeen(window, 0, 0, larger.view());
}

TEST_F(AppWindows, keepChildWindowsOnTop) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 80, 60, 0);
    (void)client_->makeWindow(10, 10, 20, 20, kBlue, 0, window);
    openOutput(configFor(window));
    const OwnedPicture picture = noisePicture(80, 60, 1);
    show(picture);
    OwnedPicture expected(picture.view());
    copyInto(expected, 10, 30, plainPicture(20, 20, 0, 0, 255).view());
    expectSeen(window, 0, 0, expected.view());
}

TEST_F(AppWindows, surviveUnmappedAndDestroyedWindows) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 80, 60, 0);
    const OwnedPicture picture = noisePicture(80, 60, 1);
    openOutput(configFor(window));
    client_->unmapWindow(window);
    show(picture);
    EXPECT_FALSE(output_->windowGone());
    client_->destroyWindow(window);
    show(picture);
    EXPECT_TRUE(output_->windowGone());
    show(picture);
    EXPECT_TRUE(output_->windowGone());
}

// X servers give the ids of windows that are gone to new ones, which may be of another kind.
TEST_F(AppWindows, acceptANewWindowWithTheSameId) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 80, 60, 0);
    openOutput(configFor(window));
    const OwnedPicture picture = noisePicture(80, 60, 1);
    show(picture);
    client_->destroyWindow(window);
    const xcb_colormap_t colours = xcb_generate_id(client_->get());
    xcb_visualid_t visual = 0;
    for (auto d = xcb_screen_allowed_depths_iterator(&client_->screen()); d.rem > 0; xcb_depth_next(&d))
        if (d.data->depth == 32) visual = xcb_depth_visuals_iterator(d.data).data->visual_id;
    xcb_create_colormap(client_->get(), 0, colours, client_->root(), visual);
    const uint32_t values[] = {0, 0, colours};
    xcb_create_window(client_->get(), 32, window, client_->root(), 0, 0, 80, 60, 0, XCB_WINDOW_CLASS_INPUT_OUTPUT,
                      visual, XCB_CW_BACK_PIXEL | XCB_CW_BORDER_PIXEL | XCB_CW_COLORMAP, values);
    xcb_map_window(client_->get(), window);
    client_->sync();
    show(picture);
    EXPECT_FALSE(output_->windowGone());
    expectSeen(window, 0, 0, picture.view());
}

// A program may end right after its last swap: before the picture comes, and before this output is opened.
TEST_F(AppWindows, acceptAWindowDestroyedEarlier) {
    startServer();
    auto output = AppWindow::open(configFor(0x7777777));
    ASSERT_TRUE(output) << output.error().message;
    EXPECT_TRUE(output.value()->windowGone());
    EXPECT_TRUE(output.value()->show(1, noisePicture(20, 10, 7).view()));
    EXPECT_TRUE(output.value()->windowGone());
}

class OwnedWindows : public AppWindows {
protected:
    void SetUp() override {
        AppWindows::SetUp();
        startServer();
        auto connection = XConnection::open(server_->displayName(), Deadline::inMs(10'000));
        ASSERT_TRUE(connection) << connection.error().message;
        program_ = std::move(connection.value());
        window_ = client_->makeWindow(0, 0, 40, 30, kBlue);
    }
    void mark(const WindowOwner& owner) {
        const Deadline deadline = Deadline::inMs(10'000);
        ASSERT_TRUE(markWindow(*program_, window_, owner, deadline));
        ASSERT_EQ(program_->awaitFence(program_->sendFence(), deadline), XAnswer::Reply);
    }
    void openFor(const WindowOwner& owner) {
        AppWindowConfig config = configFor(window_);
        config.owner = owner;
        openOutput(config);
    }
    void expectUntouched() {
        auto seen = client_->see(window_, 0, 0, 1, 1);
        ASSERT_TRUE(seen) << seen.error().message;
        EXPECT_EQ(static_cast<int>(seen->view().bgra[0]), 255);
        EXPECT_EQ(static_cast<int>(seen->view().bgra[2]), 0);
    }

    std::unique_ptr<XConnection> program_;
    uint32_t window_ = 0;
    const OwnedPicture picture_ = noisePicture(40, 30, 1);
};

TEST_F(OwnedWindows, showsInTheProgramsWindow) {
    mark({7, 1, 5});
    openFor({7, 1, 5});
    show(picture_);
    expectSeen(window_, 0, 0, picture_.view());
}

TEST_F(OwnedWindows, paintsNothingInAnothersWindow) {
    mark({7, 1, 5});
    for (const WindowOwner other : {WindowOwner{8, 1, 5}, WindowOwner{7, 2, 5}, WindowOwner{7, 1, 6}}) {
        openFor(other);
        const auto shown = output_->show(1, picture_.view());
        ASSERT_FALSE(shown);
        EXPECT_NE(shown.error().message.find("does not belong to the program"), std::string::npos);
        EXPECT_TRUE(output_->show(2, picture_.view())); // said once
        expectUntouched();
    }
}

TEST_F(OwnedWindows, paintsNothingWhenTheWindowBecomesAnothers) {
    mark({7, 1, 5});
    openFor({7, 1, 5});
    show(picture_);
    mark({7, 1, 6}); // the number is given to the next window
    const OwnedPicture next = noisePicture(40, 30, 2);
    EXPECT_TRUE(output_->show(2, next.view()));
    EXPECT_TRUE(output_->windowGone());
    expectSeen(window_, 0, 0, picture_.view());
    mark({7, 1, 5});
    EXPECT_TRUE(output_->show(3, next.view()));
    expectSeen(window_, 0, 0, next.view());
}

TEST_F(AppWindows, reportMissingServersAndWindows) {
    startServer();
    AppWindowConfig config;
    config.displayName = ":64999";
    auto noServer = AppWindow::open(config);
    ASSERT_FALSE(noServer);
    EXPECT_NE(noServer.error().message.find("':64999'"), std::string::npos);
    config.displayName = "nonsense";
    auto noName = AppWindow::open(config);
    ASSERT_FALSE(noName);
    EXPECT_NE(noName.error().message.find("not the name"), std::string::npos);
}

class StoppedServer : public AppWindows, public testing::WithParamInterface<bool> {};

TEST_P(StoppedServer, delaysPicturesUntilItContinues) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 700, 500, 0);
    AppWindowConfig config = configFor(window, GetParam());
    config.timeoutMs = 150;
    const OwnedPicture first = noisePicture(700, 500, 1);
    const OwnedPicture second = noisePicture(700, 500, 2);
    // On a busy machine even a server that runs may be too slow for this deadline.
    const auto showsSoon = [&](const OwnedPicture& picture) {
        for (int i = 0; i < 100; ++i)
            if (output_->show(1, picture.view())) return true;
        return false;
    };
    for (int i = 0; i < 100 && !output_; ++i)
        if (auto output = AppWindow::open(config); output) output_ = std::move(output.value());
    ASSERT_NE(output_, nullptr);
    ASSERT_TRUE(showsSoon(first));
    ASSERT_EQ(::kill(server_->pid(), SIGSTOP), 0);
    for (int i = 0; i < 3; ++i) {
        const int64_t beforeNs = monotonicNowNs();
        Result<void> shown = output_->show(100, second.view());
        EXPECT_FALSE(shown);
        if (!shown) {
            EXPECT_NE(shown.error().message.find("does not answer in time"), std::string::npos)
                << shown.error().message;
        }
        EXPECT_LT(monotonicNowNs() - beforeNs, 10 * kNsPerS);
    }
    EXPECT_TRUE(output_->isBlocked());
    auto late = AppWindow::open(config);
    ASSERT_TRUE(late); // it connects when the server answers
    EXPECT_FALSE(late.value()->show(101, second.view()));
    EXPECT_TRUE(late.value()->isBlocked());
    ASSERT_EQ(::kill(server_->pid(), SIGCONT), 0);
    EXPECT_TRUE(showsSoon(second));
    EXPECT_FALSE(output_->isBlocked());
    expectSeen(window, 0, 0, second.view());
    output_ = std::move(late.value());
    EXPECT_TRUE(showsSoon(first));
    expectSeen(window, 0, 0, first.view());
}

INSTANTIATE_TEST_SUITE_P(Ways, StoppedServer, testing::Bool(),
                         [](const auto& shared) { return shared.param ? "sharedMemory" : "connection"; });

TEST_F(AppWindows, reportAServerThatEnds) {
    startServer();
    const uint32_t window = client_->makeWindow(0, 0, 80, 60, 0);
    openOutput(configFor(window));
    const OwnedPicture picture = noisePicture(80, 60, 1);
    show(picture);
    server_->kill();
    for (int i = 0; i < 2; ++i) {
        Result<void> shown = output_->show(2, picture.view());
        ASSERT_FALSE(shown);
        EXPECT_NE(shown.error().message.find("is lost"), std::string::npos) << shown.error().message;
    }
}

} // namespace mural::test
