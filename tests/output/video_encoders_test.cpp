// The choice of a video encoder from FFmpeg's list.
#include "nodes/output/files/video_encoders.hpp"

#include <gtest/gtest.h>

namespace mural::test {

TEST(VideoEncoders, parseTheListing) {
    const auto names = encodersIn("Encoders:\n V..... = Video\n A..... = Audio\n ------\n"
                                  " V....D libx264rgb           libx264 H.264 (codec h264)\n"
                                  " VFS... ffv1                 FFmpeg video codec #1\n"
                                  " A....D aac                  AAC\n");
    EXPECT_EQ(names, (std::set<std::string>{"libx264rgb", "ffv1"}));
}

TEST(VideoEncoders, acceptSuffixesInAnyCase) {
    EXPECT_EQ(suffixOf("a.b/run.MP4"), "mp4");
    EXPECT_EQ(suffixOf("a.b/run"), "");
    EXPECT_TRUE(isVideoSuffix("webm"));
    EXPECT_FALSE(isVideoSuffix("gif"));
    EXPECT_FALSE(isVideoSuffix(""));
}

TEST(VideoEncoders, useTheSecondChoiceWithoutTheFirst) {
    const std::set<std::string> all = {"libx264rgb", "ffv1", "qtrle", "png", "libvpx-vp9"};
    const std::set<std::string> without = {"ffv1", "qtrle", "png"};
    EXPECT_EQ(chooseEncoding("mp4", all)->encoder, "libx264rgb");
    EXPECT_EQ(chooseEncoding("mkv", without)->encoder, "ffv1");
    EXPECT_EQ(chooseEncoding("avi", without)->encoder, "ffv1");
    EXPECT_EQ(chooseEncoding("mov", without)->encoder, "qtrle");
    EXPECT_EQ(chooseEncoding("mp4", without)->encoder, "png");
    EXPECT_EQ(chooseEncoding("webm", all)->encoder, "libvpx-vp9");
}

TEST(VideoEncoders, nameARemedyInErrors) {
    auto missing = chooseEncoding("webm", {"ffv1"});
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("libvpx-vp9"), std::string::npos);
    auto unknown = chooseEncoding("gif", {"ffv1"});
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find(".mkv"), std::string::npos);
}

} // namespace mural::test
