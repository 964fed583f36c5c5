#include "tools/mural/app_report/output/report_html.hpp"

#include <filesystem>
#include <fstream>
#include <fmt/format.h>
#include <iterator>

#include "nodes/output/files/png_files.hpp"
#include "tools/mural/app_report/output/report_text.hpp"
#include "tools/mural/app_report/runs/window_picture.hpp"

namespace mural::cli {

namespace {

constexpr int kPictureWidth = 320;

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#1c2126;"
    "background:#fff}h1{font-size:1.4rem}h2{font-size:1.05rem;margin:1.6rem 0 .3rem}table{border-collapse:collapse;"
    "width:100%}td{padding:.22rem .6rem;border-top:1px solid #d8dde2;vertical-align:top}td:first-child{width:16rem;"
    "color:#4a545e}code{background:#eef1f4;padding:.15rem .4rem;border-radius:.25rem}.verdict{display:inline-block;"
    "padding:.2rem .7rem;border-radius:.3rem;color:#fff;font-weight:600}.exact{background:#1a7f43}.other{background:"
    "#9a6200}.no{background:#b3261e}.advice{color:#4a545e}figure{display:inline-block;margin:.6rem 1rem .6rem 0}"
    "figcaption{color:#4a545e;font-size:.85rem}@media(prefers-color-scheme:dark){body{background:#15191d;color:"
    "#e4e8ec}td{border-color:#333b43}td:first-child,.advice,figcaption{color:#a9b4be}code{background:#262d34}}";

std::string base64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

// Returns the picture as a figure; empty: it cannot be read.
std::string figureOf(const std::string& file, const std::string& caption) {
    if (file.empty()) return {};
    const auto picture = readPng(file);
    if (!picture) return {};
    const OwnedPicture small = reduced(picture.value().view(), kPictureWidth);
    const std::string smallFile = file + ".small.png";
    if (!writePng(smallFile, small.view())) return {};
    std::ifstream stream(smallFile, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    return fmt::format("<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" src=\"data:image/png;base64,{3}\">"
                       "<figcaption>{0}</figcaption></figure>",
                       caption, small.width(), small.height(), base64(bytes));
}

const char* classOf(Verdict verdict) {
    return verdict == Verdict::Exact ? "exact" : verdict == Verdict::Differences ? "other" : "no";
}

} // namespace

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '&': result += "&amp;"; break;
        case '"': result += "&quot;"; break;
        default: result += c;
        }
    }
    return result;
}

std::string htmlOf(const AppReport& report) {
    const std::string name = escaped(programText(report));
    std::string page =
        fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
                    "name=\"viewport\" content=\"width=device-width\"><title>{0} on Mural</title>"
                    "<style>{1}</style></head><body>\n<h1>{0}</h1>\n<p><span class=\"verdict {2}\">{3}"
                    "</span> {4}</p>\n",
                    name, kStyle, classOf(report.verdict), nameOf(report.verdict), escaped(report.sentence));
    if (!report.recommended.empty()) page += "<p>Use <code>" + escaped(report.recommended) + "</code></p>\n";
    page += figureOf(report.nativePicture, "without Mural") + figureOf(report.wallPicture, "on the wall");
    for (const Section& s : report.sections) {
        page += "\n<h2>" + escaped(s.title) + "</h2>\n<table>\n";
        for (const Fact& f : s.facts)
            page += fmt::format(
                "<tr><td>{}</td><td>{}{}</td></tr>\n", escaped(f.label), escaped(f.text),
                f.advice.empty() ? "" : "<br><span class=\"advice\">&rarr; " + escaped(f.advice) + "</span>");
        page += "</table>\n";
    }
    return page + "</body></html>\n";
}

} // namespace mural::cli
