#include "nodes/output/png_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "tests/output/scratch_folder.hpp"
#include "tests/output/test_pictures.hpp"

namespace mural::test {

TEST(PngFiles, comeBackExactly) {
    const ScratchFolder scratch;
    const int sizes[][2] = {{1, 1}, {1, 7}, {640, 480}, {257, 3}};
    auto files = PngFiles::open(scratch.path("new/folder"));
    ASSERT_TRUE(files) << files.error().message;
    int64_t frame = 0;
    for (const auto& size : sizes) {
        const OwnedPicture picture = noisePicture(size[0], size[1], static_cast<uint32_t>(frame));
        Result<void> shown = files.value()->show(++frame, picture.view());
        ASSERT_TRUE(shown) << shown.error().message;
        auto read = readPng(files.value()->lastPath());
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_TRUE(samePictures(picture.view(), read->view()));
    }
    EXPECT_EQ(files.value()->filesWritten(), 4);
    EXPECT_TRUE(std::filesystem::exists(scratch.path("new/folder/frame-000001.png")));
    EXPECT_TRUE(std::filesystem::exists(scratch.path("new/folder/frame-000004.png")));
}

// Somebody else's decoder must see red where we saw red, and the right side up.
TEST(PngFiles, otherProgramsSeeTheSame) {
    const ScratchFolder scratch;
    OwnedPicture picture = plainPicture(2, 2, 0, 0, 0);
    setPixel(picture, 0, 1, 255, 128, 1); // upper left
    ASSERT_TRUE(writePng(scratch.path("a.png"), picture.view()));
    const std::string command = "ffmpeg -nostdin -v error -i " + scratch.path("a.png") +
                                " -f rawvideo -pix_fmt rgb24 " + scratch.path("raw");
    ASSERT_EQ(std::system(command.c_str()), 0) << "install Debian's package ffmpeg";
    std::ifstream raw(scratch.path("raw"), std::ios::binary);
    unsigned char bytes[12] = {};
    ASSERT_TRUE(raw.read(reinterpret_cast<char*>(bytes), sizeof bytes));
    EXPECT_EQ(bytes[0], 255);
    EXPECT_EQ(bytes[1], 128);
    EXPECT_EQ(bytes[2], 1);
    EXPECT_TRUE(std::all_of(bytes + 3, bytes + 12, [](int b) { return b == 0; }));
}

TEST(PngFiles, fullDiskIsSaid) {
    const ScratchFolder scratch;
    auto files = PngFiles::open(scratch.path());
    ASSERT_TRUE(files);
    // A device on which every write fails as on a full disk takes the place of the file.
    ASSERT_EQ(::symlink("/dev/full", scratch.path("frame-000007.png.part").c_str()), 0);
    const OwnedPicture picture = noisePicture(300, 300, 1);
    Result<void> shown = files.value()->show(7, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("No space left on device"), std::string::npos)
        << shown.error().message;
    EXPECT_NE(shown.error().message.find("frame-000007.png"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(scratch.path("frame-000007.png")));
    EXPECT_TRUE(files.value()->show(8, picture.view())); // one failure ends nothing
}

// A picture so small that everything fits into the stream's buffer: only closing can fail.
TEST(PngFiles, fullDiskIsSaidForSmallPictures) {
    const ScratchFolder scratch;
    ASSERT_EQ(::symlink("/dev/full", scratch.path("a.png.part").c_str()), 0);
    const OwnedPicture picture = noisePicture(4, 4, 1);
    Result<void> written = writePng(scratch.path("a.png"), picture.view());
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("No space"), std::string::npos);
}

TEST(PngFiles, unusableFoldersAreSaid) {
    const ScratchFolder scratch;
    std::ofstream(scratch.path("file")) << "x";
    for (const std::string& folder : {scratch.path("file"), scratch.path("file/below")}) {
        auto files = PngFiles::open(folder);
        ASSERT_FALSE(files) << folder;
        EXPECT_NE(files.error().message.find(folder), std::string::npos) << files.error().message;
        EXPECT_NE(files.error().message.find("--out"), std::string::npos) << files.error().message;
    }
}

TEST(PngFiles, folderThatVanishesIsSaid) {
    const ScratchFolder scratch;
    auto files = PngFiles::open(scratch.path("gone"));
    ASSERT_TRUE(files);
    std::filesystem::remove(scratch.path("gone"));
    const OwnedPicture picture = noisePicture(4, 4, 1);
    Result<void> shown = files.value()->show(1, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("No such file"), std::string::npos);
}

TEST(PngFiles, emptyPicturesAreRefused) {
    const ScratchFolder scratch;
    EXPECT_FALSE(writePng(scratch.path("a.png"), Picture{}));
}

TEST(ReadPng, refusesWhatIsNoPng) {
    const ScratchFolder scratch;
    EXPECT_FALSE(readPng(scratch.path("missing.png")));
    std::ofstream(scratch.path("text.png")) << "not a picture at all, really";
    auto text = readPng(scratch.path("text.png"));
    ASSERT_FALSE(text);
    EXPECT_NE(text.error().message.find("not a usable PNG"), std::string::npos);
    // Cut off in the middle of the pixels.
    const OwnedPicture picture = noisePicture(64, 64, 1);
    ASSERT_TRUE(writePng(scratch.path("cut.png"), picture.view()));
    std::filesystem::resize_file(scratch.path("cut.png"),
                                 std::filesystem::file_size(scratch.path("cut.png")) / 2);
    EXPECT_FALSE(readPng(scratch.path("cut.png")));
}

} // namespace mural::test
