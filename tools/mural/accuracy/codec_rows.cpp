// Measures the losses and the costs of all picture codecs (measureCodecs of composition_rows.hpp).
#include <fmt/format.h>

#include "common/base/clock.hpp"
#include "compositor/codecs/registry.hpp"
#include "tools/mural/accuracy/composition_rows.hpp"
#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

using namespace compositor;

namespace {

// Pictures are BGRA, planes are RGBA.
Plane planeOf(const Picture& picture) {
    Plane plane(PlaneFormat::Rgba8, picture.width, picture.height);
    for (size_t i = 0; i < picture.sizeBytes(); i += 4)
        for (size_t c = 0; c < 4; ++c) plane.bytes()[i + c] = c == 3 ? std::byte{255} : picture.bgra[i + 2 - c];
    return plane;
}

MeasuredError errorOfPlanes(const Plane& wanted, const Plane& got) {
    MeasuredError error;
    for (size_t i = 0; i < wanted.bytes().size(); i += 4) {
        bool differs = false;
        for (size_t c = 0; c < 3; ++c) {
            const int d = std::to_integer<int>(got.bytes()[i + c]) - std::to_integer<int>(wanted.bytes()[i + c]);
            error.addValue(d);
            differs = differs || d != 0;
        }
        ++error.pixels;
        error.differing += differs;
    }
    return error;
}

AccuracyRow codecRow(CodecRegistry& registry, const std::string& group, const std::string& name, const Bound& bound,
                     const std::vector<Plane>& planes) {
    AccuracyRow row{group, name, "the picture", {}, bound, {}};
    size_t before = 0, packed = 0;
    int64_t tookNs = 0;
    auto codec = registry.make(name);
    if (!codec) row.failure = codec.error().message;
    for (const Plane& plane : planes) {
        if (Interruption::signal() != 0) row.failure = "the measurement was interrupted";
        if (!row.failure.empty()) return row;
        std::vector<std::byte> bytes((*codec)->boundBytes(shapeOf(plane.view())));
        Plane back(PlaneFormat::Rgba8, plane.width(), plane.height());
        const auto measured = [&]() -> Result<void> {
            const int64_t beganNs = threadCpuNowNs();
            auto size = (*codec)->encode(plane.view(), bytes);
            if (!size) return size.error();
            packed += *size;
            before += plane.bytes().size();
            auto decoded = (*codec)->decode(std::span(bytes).first(*size), back.view());
            tookNs += threadCpuNowNs() - beganNs;
            return decoded;
        }();
        if (!measured) row.failure = measured.error().message;
        row.error.add(errorOfPlanes(plane, back));
    }
    const double pixels = static_cast<double>(std::max<size_t>(before, 4)) / 4;
    row.cost = Cost{static_cast<double>(tookNs) / pixels, static_cast<double>(packed) / pixels};
    row.what = fmt::format("{}, compressed by a factor of {:.3g}", name,
                           static_cast<double>(before) / static_cast<double>(std::max<size_t>(packed, 1)));
    return row;
}

} // namespace

void measureCodecs(const std::vector<OwnedPicture>& pictures, const std::string& group, bool quick,
                   std::vector<AccuracyRow>& rows) {
    if (pictures.empty()) return;
    std::vector<Plane> planes;
    for (const OwnedPicture& p : pictures) planes.push_back(planeOf(p.view()));
    CodecRegistry registry;
    for (const CodecInfo& codec : registry.losslessFor(PlaneFormat::Rgba8))
        if (!quick || codec.name == "bitplane" || codec.name == "zstd")
            rows.push_back(codecRow(registry, group, codec.name, Bound::exact(), planes));
    // Lossy codecs are selected by name only. Their bounds are their own losses; a fault would lose more.
    for (const auto& [name, psnr] : {std::pair("yuv420", 28.0), std::pair("jpeg-100", 30.0), std::pair("jpeg-95", 28.0),
                                     std::pair("jpeg-80", 25.0), std::pair("jpeg-50", 22.0)})
        if (!quick || std::string(name) == "yuv420" || std::string(name) == "jpeg-95")
            rows.push_back(codecRow(registry, group, name, {{}, {}, psnr}, planes));
}

} // namespace mural::cli
