// Pictures as PNG files: exact contents, and errors of folders and disks.
#include "nodes/output/files/png_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "tests/temporary_folder.hpp"
#include "tests/output/test_pictures.hpp"

namespace mural::test {

TEST(PngFiles, roundTripExactly) {
    const TemporaryFolder folder;
    const int sizes[][2] = {{1, 1}, {1, 7}, {640, 480}, {257, 3}};
    auto files = PngFiles::open(folder.at("new/folder"));
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
    EXPECT_TRUE(std::filesystem::exists(folder.at("new/folder/frame-000001.png")));
    EXPECT_TRUE(std::filesystem::exists(folder.at("new/folder/frame-000004.png")));
}

// Another decoder must see the same colours and orientation.
TEST(PngFiles, lookTheSameToOtherPrograms) {
    const TemporaryFolder folder;
    OwnedPicture picture = plainPicture(2, 2, 0, 0, 0);
    setPixel(picture, 0, 1, 255, 128, 1); // upper left
    ASSERT_TRUE(writePng(folder.at("a.png"), picture.view()));
    const std::string command =
        "ffmpeg -nostdin -v error -i " + folder.at("a.png") + " -f rawvideo -pix_fmt rgb24 " + folder.at("raw");
    ASSERT_EQ(std::system(command.c_str()), 0) << "install Debian's package ffmpeg";
    std::ifstream raw(folder.at("raw"), std::ios::binary);
    unsigned char bytes[12] = {};
    ASSERT_TRUE(raw.read(reinterpret_cast<char*>(bytes), sizeof bytes));
    EXPECT_EQ(bytes[0], 255);
    EXPECT_EQ(bytes[1], 128);
    EXPECT_EQ(bytes[2], 1);
    EXPECT_TRUE(std::all_of(bytes + 3, bytes + 12, [](int b) { return b == 0; }));
}

TEST(PngFiles, reportAFullDisk) {
    const TemporaryFolder folder;
    auto files = PngFiles::open(folder.path());
    ASSERT_TRUE(files);
    // A device on which every write fails like on a full disk replaces the file.
    ASSERT_EQ(::symlink("/dev/full", folder.at("frame-000007.png.part").c_str()), 0);
    const OwnedPicture picture = noisePicture(300, 300, 1);
    Result<void> shown = files.value()->show(7, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("No space left on device"), std::string::npos) << shown.error().message;
    EXPECT_NE(shown.error().message.find("frame-000007.png"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.at("frame-000007.png")));
    EXPECT_TRUE(files.value()->show(8, picture.view())); // one failure does not end the sink
}

// A picture that fits into the stream's buffer: only closing can fail.
TEST(PngFiles, reportAFullDiskForSmallPictures) {
    const TemporaryFolder folder;
    ASSERT_EQ(::symlink("/dev/full", folder.at("a.png.part").c_str()), 0);
    const OwnedPicture picture = noisePicture(4, 4, 1);
    Result<void> written = writePng(folder.at("a.png"), picture.view());
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find("No space"), std::string::npos);
}

TEST(PngFiles, reportUnusableFolders) {
    const TemporaryFolder folder;
    std::ofstream(folder.at("file")) << "x";
    for (const std::string& path : {folder.at("file"), folder.at("file/below")}) {
        auto files = PngFiles::open(path);
        ASSERT_FALSE(files) << path;
        EXPECT_NE(files.error().message.find(path), std::string::npos) << files.error().message;
        EXPECT_NE(files.error().message.find("--out"), std::string::npos) << files.error().message;
    }
}

TEST(PngFiles, reportAFolderThatVanishes) {
    const TemporaryFolder folder;
    auto files = PngFiles::open(folder.at("gone"));
    ASSERT_TRUE(files);
    std::filesystem::remove(folder.at("gone"));
    const OwnedPicture picture = noisePicture(4, 4, 1);
    Result<void> shown = files.value()->show(1, picture.view());
    ASSERT_FALSE(shown);
    EXPECT_NE(shown.error().message.find("No such file"), std::string::npos);
}

TEST(PngFiles, rejectEmptyPictures) {
    const TemporaryFolder folder;
    EXPECT_FALSE(writePng(folder.at("a.png"), Picture{}));
}

TEST(ReadPng, rejectsOtherFiles) {
    const TemporaryFolder folder;
    EXPECT_FALSE(readPng(folder.at("missing.png")));
    std::ofstream(folder.at("text.png")) << "not a picture at all, really";
    auto text = readPng(folder.at("text.png"));
    ASSERT_FALSE(text);
    EXPECT_NE(text.error().message.find("not a usable PNG"), std::string::npos);
    // Truncated within the pixels.
    const OwnedPicture picture = noisePicture(64, 64, 1);
    ASSERT_TRUE(writePng(folder.at("cut.png"), picture.view()));
    std::filesystem::resize_file(folder.at("cut.png"), std::filesystem::file_size(folder.at("cut.png")) / 2);
    EXPECT_FALSE(readPng(folder.at("cut.png")));
}

} // namespace mural::test
