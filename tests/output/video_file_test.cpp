// Videos: decoded frames, changed sizes, failing encoders.
#include "nodes/output/files/video_file.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/recorded_log.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/output/test_pictures.hpp"

namespace mural::test {

namespace {

// All frames of a video as pictures, decoded by ffmpeg without frame rate conversion.
std::vector<OwnedPicture> decode(const TemporaryFolder& folder, const std::string& path, int width, int height) {
    const std::string raw = folder.at("decoded");
    const std::string command =
        "ffmpeg -nostdin -y -v error -i " + path + " -vf vflip -fps_mode passthrough -f rawvideo -pix_fmt bgra " + raw;
    if (std::system(command.c_str()) != 0) return {};
    std::vector<OwnedPicture> frames;
    std::ifstream file(raw, std::ios::binary);
    for (;;) {
        OwnedPicture frame(width, height);
        const auto sizeBytes = static_cast<std::streamsize>(frame.view().sizeBytes());
        if (!file.read(reinterpret_cast<char*>(frame.data()), sizeBytes)) return frames;
        frames.push_back(std::move(frame));
    }
}

VideoConfig configFor(const std::string& path) {
    VideoConfig config;
    config.path = path;
    return config;
}

// A fake ffmpeg that lists all encoders and then executes `text`.
std::string fakeEncoder(const TemporaryFolder& folder, const std::string& text) {
    return folder.script("fake-ffmpeg", "if [ \"$2\" = -encoders ]; then\n"
                                        "echo ' V....D libx264rgb x'; exit 0\nfi\n" +
                                            text);
}

} // namespace

class VideoFormats : public testing::TestWithParam<std::string> {};

TEST_P(VideoFormats, decodeBitExactly) {
    const TemporaryFolder folder;
    const std::string path = folder.at("run." + GetParam());
    constexpr int kWidth = 161; // odd: no format may require even sizes
    constexpr int kHeight = 97;
    constexpr int kFrames = 7;
    auto video = VideoFile::open(configFor(path));
    ASSERT_TRUE(video) << video.error().message;
    std::vector<OwnedPicture> written;
    for (int i = 0; i < kFrames; ++i) {
        written.push_back(noisePicture(kWidth, kHeight, static_cast<uint32_t>(i)));
        // Two equal consecutive frames must stay two frames.
        if (i == 4) written.back().assign(written[3].view());
        Result<void> shown = video.value()->show(i + 1, written.back().view());
        ASSERT_TRUE(shown) << shown.error().message;
    }
    Result<void> finished = video.value()->finish();
    ASSERT_TRUE(finished) << finished.error().message;
    EXPECT_TRUE(video.value()->finish());
    const std::vector<OwnedPicture> decoded = decode(folder, path, kWidth, kHeight);
    ASSERT_EQ(decoded.size(), written.size());
    for (size_t i = 0; i < written.size(); ++i)
        EXPECT_TRUE(samePictures(written[i].view(), decoded[i].view())) << "frame " << i;
}

INSTANTIATE_TEST_SUITE_P(All, VideoFormats, testing::Values("mp4", "mkv", "avi", "webm", "mov"),
                         [](const auto& format) { return format.param; });

TEST(VideoFile, startsANumberedFileForANewSize) {
    const TemporaryFolder folder;
    VideoConfig config = configFor(folder.at("run.mkv"));
    const RecordedLog log;
    auto video = VideoFile::open(std::move(config));
    ASSERT_TRUE(video) << video.error().message;
    const OwnedPicture small = noisePicture(32, 16, 1);
    const OwnedPicture large = noisePicture(40, 20, 2);
    ASSERT_TRUE(video.value()->show(1, small.view()));
    ASSERT_TRUE(video.value()->show(2, large.view()));
    ASSERT_TRUE(video.value()->show(3, large.view()));
    ASSERT_TRUE(video.value()->finish());
    const auto first = decode(folder, folder.at("run.mkv"), 32, 16);
    const auto second = decode(folder, folder.at("run-2.mkv"), 40, 20);
    ASSERT_EQ(first.size(), 1U);
    ASSERT_EQ(second.size(), 2U);
    EXPECT_TRUE(samePictures(small.view(), first[0].view()));
    EXPECT_TRUE(samePictures(large.view(), second[1].view()));
    const std::vector<std::string> messages = log.texts();
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_NE(messages[0].find("32x16 to 40x20 at frame 2"), std::string::npos) << messages[0];
    EXPECT_NE(messages[0].find("run-2.mkv"), std::string::npos) << messages[0];
}

TEST(VideoFile, completesWhenDestroyed) {
    const TemporaryFolder folder;
    const OwnedPicture picture = noisePicture(32, 16, 1);
    {
        auto video = VideoFile::open(configFor(folder.at("run.mp4")));
        ASSERT_TRUE(video) << video.error().message;
        ASSERT_TRUE(video.value()->show(1, picture.view()));
    }
    EXPECT_EQ(decode(folder, folder.at("run.mp4"), 32, 16).size(), 1U);
}

TEST(VideoFile, detectsAKilledEncoder) {
    const TemporaryFolder folder;
    auto video = VideoFile::open(configFor(folder.at("run.mkv")));
    ASSERT_TRUE(video) << video.error().message;
    const OwnedPicture picture = noisePicture(64, 64, 1);
    ASSERT_TRUE(video.value()->show(1, picture.view()));
    const pid_t encoder = video.value()->encoderPid();
    ASSERT_GT(encoder, 0);
    ASSERT_EQ(::kill(encoder, SIGKILL), 0);
    Result<void> shown;
    for (int i = 2; i < 10'000 && shown; ++i) shown = video.value()->show(i, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("killed by signal 9"), std::string::npos) << shown.error().message;
    EXPECT_NE(::kill(encoder, 0), 0); // reaped
    EXPECT_FALSE(video.value()->show(10'000, picture.view()));
}

TEST(VideoFile, quotesAnEncoderThatFails) {
    const TemporaryFolder folder;
    VideoConfig config = configFor(folder.at("run.mkv"));
    config.program = fakeEncoder(folder, "echo first >&2\necho 'disk quota is gone' >&2\nexit 3\n");
    auto video = VideoFile::open(std::move(config));
    ASSERT_TRUE(video) << video.error().message;
    const OwnedPicture picture = noisePicture(512, 512, 1); // more than the socket buffers
    Result<void> shown;
    for (int i = 1; i < 1000 && shown; ++i) shown = video.value()->show(i, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("exit code 3: first; disk quota is gone"), std::string::npos)
        << shown.error().message;
}

// The file cannot be created: detected by finish() if the few bytes entered the socket before.
TEST(VideoFile, reportsARealEncoderThatCannotWrite) {
    const TemporaryFolder folder;
    auto video = VideoFile::open(configFor(folder.at("folder/run.mkv")));
    ASSERT_TRUE(video) << video.error().message;
    std::filesystem::remove(folder.at("folder"));
    const OwnedPicture picture = noisePicture(16, 16, 1);
    Result<void> result = video.value()->show(1, picture.view());
    if (result) result = video.value()->finish();
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("No such file or directory"), std::string::npos) << result.error().message;
}

TEST(VideoFile, reportsAFullDisk) {
    for (const char* name : {"run.mp4", "run.mkv", "run.avi", "run.webm", "run.mov"}) {
        const TemporaryFolder folder;
        std::filesystem::create_symlink("/dev/full", folder.at(name));
        auto video = VideoFile::open(configFor(folder.at(name)));
        ASSERT_TRUE(video) << video.error().message;
        const OwnedPicture picture = noisePicture(256, 256, 1);
        Result<void> result;
        for (int i = 1; i < 20 && result; ++i) result = video.value()->show(i, picture.view());
        if (result) result = video.value()->finish();
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("No space left on device"), std::string::npos) << result.error().message;
    }
}

TEST(VideoFile, stopsAtTheDeadlineWhenTheEncoderDoesNotRead) {
    const TemporaryFolder folder;
    VideoConfig config = configFor(folder.at("run.mkv"));
    config.program = fakeEncoder(folder, "exec tail -f /dev/null\n");
    config.frameTimeoutMs = 50;
    config.finishTimeoutMs = 50;
    auto video = VideoFile::open(config);
    ASSERT_TRUE(video) << video.error().message;
    const OwnedPicture picture = noisePicture(1024, 1024, 1);
    Result<void> shown;
    for (int i = 1; i < 100 && shown; ++i) shown = video.value()->show(i, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("does not read more data"), std::string::npos) << shown.error().message;
    // The same for an encoder that does not end.
    auto second = VideoFile::open(config);
    ASSERT_TRUE(second);
    const OwnedPicture tiny = noisePicture(2, 2, 1);
    ASSERT_TRUE(second.value()->show(1, tiny.view()));
    const pid_t encoder = second.value()->encoderPid();
    Result<void> finished = second.value()->finish();
    ASSERT_FALSE(finished);
    EXPECT_NE(finished.error().message.find("did not end in time"), std::string::npos);
    EXPECT_NE(::kill(encoder, 0), 0); // gone and reaped
}

TEST(VideoFile, namesThePackageOfAMissingProgram) {
    const TemporaryFolder folder;
    VideoConfig config = configFor(folder.at("run.mkv"));
    config.program = "no-such-ffmpeg";
    auto video = VideoFile::open(std::move(config));
    ASSERT_FALSE(video);
    EXPECT_NE(video.error().message.find("package ffmpeg"), std::string::npos) << video.error().message;
}

TEST(VideoFile, rejectsUnusableNamesAtOnce) {
    const TemporaryFolder folder;
    std::ofstream(folder.at("file")) << "x";
    std::filesystem::create_directory(folder.at("folder.mp4"));
    for (const char* name : {"a.gif", "a", "file/a.mp4", "folder.mp4"}) {
        auto video = VideoFile::open(configFor(folder.at(name)));
        EXPECT_FALSE(video) << name;
    }
}

} // namespace mural::test
