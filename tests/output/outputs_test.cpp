// The choice of an output by its name.
#include "nodes/output/outputs.hpp"

#include <filesystem>

#include "tests/temporary_folder.hpp"
#include "tests/output/test_pictures.hpp"

namespace mural::test {

TEST(Outputs, selectTheKindByName) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.at("old.mp4"));
    EXPECT_EQ(outputKindOf("run.mp4").value(), OutputKind::Video);
    EXPECT_EQ(outputKindOf("a/b/run.WebM").value(), OutputKind::Video);
    EXPECT_EQ(outputKindOf("run").value(), OutputKind::Folder);
    EXPECT_EQ(outputKindOf("run.1").value(), OutputKind::Folder);
    EXPECT_EQ(outputKindOf("run.mp4/").value(), OutputKind::Folder);
    EXPECT_EQ(outputKindOf(folder.at("old.mp4")).value(), OutputKind::Folder);
    EXPECT_FALSE(outputKindOf(""));
    auto gif = outputKindOf("run.gif");
    ASSERT_FALSE(gif);
    EXPECT_NE(gif.error().message.find(".webm"), std::string::npos);
}

TEST(Outputs, openTheKindOfTheName) {
    const TemporaryFolder folder;
    const OwnedPicture picture = noisePicture(16, 16, 1);
    for (const char* name : {"pictures", "run.mkv"}) {
        auto sink = openOutput(folder.at(name));
        ASSERT_TRUE(sink) << sink.error().message;
        EXPECT_NE(sink.value()->describe().find(name), std::string::npos);
        EXPECT_TRUE(sink.value()->show(1, picture.view()));
        EXPECT_TRUE(sink.value()->finish());
    }
    EXPECT_TRUE(std::filesystem::exists(folder.at("pictures/frame-000001.png")));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.at("run.mkv")));
    EXPECT_FALSE(openOutput("run.gif"));
}

} // namespace mural::test
