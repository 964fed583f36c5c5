// The report as text and as a page.
#include <filesystem>
#include <gtest/gtest.h>

#include "nodes/output/files/png_files.hpp"
#include "tools/mural/app_report/output/report_html.hpp"
#include "tools/mural/app_report/output/report_json.hpp"
#include "tools/mural/app_report/output/report_text.hpp"
#include "tools/mural/app_report/runs/window_picture.hpp"

namespace mural::cli {
namespace {

AppReport someReport() {
    AppReport report;
    report.program = {"app", "<b>"};
    report.verdict = Verdict::Exact;
    report.sentence = "0 pixels differ";
    report.recommended = "mural run --tiles 2x2 -- app";
    Section section{"speed", "Speed", {}};
    section.add("native", "without Mural", 60.5, "60.5 frames/s & more", "use <it>");
    report.sections.push_back(section);
    return report;
}

TEST(AppReportPage, showsTheSameFactsEverywhere) {
    const AppReport report = someReport();
    const std::string text = textOf(report), page = htmlOf(report);
    EXPECT_NE(text.find("verdict  works, exact: 0 pixels differ"), std::string::npos) << text;
    EXPECT_NE(text.find("60.5 frames/s & more -> use <it>"), std::string::npos) << text;
    EXPECT_NE(page.find("60.5 frames/s &amp; more"), std::string::npos);
    EXPECT_EQ(jsonOf(report)["sections"]["speed"]["facts"]["native"]["value"], 60.5);
    EXPECT_EQ(jsonOf(report)["verdict"], "works, exact");
}

TEST(AppReportPage, escapesTextAndRefersToNoOtherFile) {
    const std::string page = htmlOf(someReport());
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    for (const char* reference : {"http:", "https:", "<script", "<link", "src=\"/"})
        EXPECT_EQ(page.find(reference), std::string::npos) << reference;
}

TEST(AppReportPage, containsSmallPictures) {
    const std::string file = testing::TempDir() + "/app_report_page.png";
    OwnedPicture picture(700, 300);
    for (int y = 0; y < 300; ++y) std::fill_n(picture.row(y), picture.rowBytes(), std::byte{200});
    ASSERT_TRUE(writePng(file, picture.view()).ok());
    AppReport report = someReport();
    report.wallPicture = file;
    const std::string page = htmlOf(report);
    EXPECT_NE(page.find("width=\"233\" height=\"100\" src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    report.wallPicture = file + ".missing";
    EXPECT_EQ(htmlOf(report).find("<figure>"), std::string::npos);
    std::filesystem::remove(file);
    std::filesystem::remove(file + ".small.png");
}

TEST(AppReportPage, reducesPicturesToTheirMean) {
    OwnedPicture picture(4, 2);
    for (int y = 0; y < 2; ++y)
        for (size_t x = 0; x < 4; ++x)
            for (size_t c = 0; c < 4; ++c)
                picture.row(y)[4 * x + c] = static_cast<std::byte>(x < 2 ? 100 + 10 * y : 40);
    const OwnedPicture small = reduced(picture.view(), 2);
    ASSERT_EQ(small.width(), 2);
    ASSERT_EQ(small.height(), 1);
    EXPECT_EQ(small.view().row(0)[0], std::byte{105});
    EXPECT_EQ(small.view().row(0)[4], std::byte{40});
}

} // namespace
} // namespace mural::cli
