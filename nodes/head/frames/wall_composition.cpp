#include "nodes/head/frames/wall_composition.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "compositor/kernels/mask_channels.hpp"
#include "nodes/output/eye_pair.hpp"

namespace mural {

namespace {

uint8_t byteAt(const Picture& p, size_t i) { return std::to_integer<uint8_t>(p.bgra[i]); }

// Resizes the last picture of a lost node, which may be older than a resize of the window. Missing pixels are black.
void fit(OwnedPicture& picture, int width, int height) {
    if (picture.width() != width || picture.height() != height) picture = cutOut(picture.view(), {0, 0, width, height});
}

// 32-bit sums hold 2^24 samples. Halves are rounded up.
void average(std::span<const Picture> samples, OwnedPicture& into) {
    into.assign(samples.front());
    if (samples.size() == 1) return;
    const size_t bytes = into.view().sizeBytes();
    const auto count = static_cast<uint32_t>(samples.size());
    std::vector<uint32_t> sums(bytes, count / 2);
    for (const Picture& p : samples) {
        OwnedPicture fitted;
        const bool fits = p.width == into.width() && p.height == into.height();
        if (!fits) fitted = cutOut(p, {0, 0, into.width(), into.height()});
        const Picture sample = fits ? p : fitted.view();
        for (size_t i = 0; i < bytes; ++i) sums[i] += byteAt(sample, i);
    }
    for (size_t i = 0; i < bytes; ++i) into.data()[i] = static_cast<std::byte>(sums[i] / count);
}

// Pixel (i, j) of a kernel picture is pixel (i * columns + its column, j * rows + its row) of the whole.
void interleave(const PassCounts& counts, std::vector<OwnedPicture>& parts, OwnedPicture& into) {
    const auto at = [&](int x, int y) -> OwnedPicture& {
        return parts[static_cast<size_t>(y) * static_cast<size_t>(counts.kernelWidth) + static_cast<size_t>(x)];
    };
    int width = 0, height = 0;
    for (int x = 0; x < counts.kernelWidth; ++x) width += at(x, 0).width();
    for (int y = 0; y < counts.kernelHeight; ++y) height += at(0, y).height();
    for (int y = 0; y < counts.kernelHeight; ++y)
        for (int x = 0; x < counts.kernelWidth; ++x)
            fit(at(x, y), (width - x + counts.kernelWidth - 1) / counts.kernelWidth,
                (height - y + counts.kernelHeight - 1) / counts.kernelHeight);
    into.resize(width, height);
    for (int y = 0; y < height; ++y) {
        for (int k = 0; k < counts.kernelWidth; ++k) {
            const Picture part = at(k, y % counts.kernelHeight).view();
            const std::byte* from = part.row(y / counts.kernelHeight);
            for (int x = k; x < width; x += counts.kernelWidth, from += kPictureBytesPerPixel)
                std::memcpy(into.row(y) + static_cast<size_t>(x) * kPictureBytesPerPixel, from, kPictureBytesPerPixel);
        }
    }
}

compositor::ChannelMask maskOf(const EyeColours& colours) {
    compositor::ChannelMask mask{};
    for (size_t i = 0; i < mask.size(); ++i) {
        const bool taken[] = {colours.blue, colours.green, colours.red, true};
        mask[i] = taken[i % kPictureBytesPerPixel] ? std::byte{255} : std::byte{0};
    }
    return mask;
}

// Composes one eye of a part: averages samples and interleaves kernel pictures.
void composeEye(const PassCounts& counts, std::span<const Picture> pictures, OwnedPicture& into) {
    std::vector<OwnedPicture> parts(static_cast<size_t>(counts.kernelWidth * counts.kernelHeight));
    const auto samples = static_cast<size_t>(counts.samples);
    for (size_t i = 0; i < parts.size(); ++i) average(pictures.subspan(i * samples, samples), parts[i]);
    if (parts.size() == 1)
        into = std::move(parts.front());
    else
        interleave(counts, parts, into);
}

bool isEmpty(const Picture& p) { return p.empty(); }

// Returns the part's picture in the size of the wall; empty if some input is missing.
OwnedPicture pictureOf(const WallPart& part, const std::vector<Picture>& pictures) {
    OwnedPicture whole;
    const auto first = static_cast<size_t>(part.firstPicture), count = static_cast<size_t>(picturesOf(part.counts));
    if (first + count > pictures.size()) return whole;
    const std::span own = std::span(pictures).subspan(first, count);
    if (!std::any_of(own.begin(), own.end(), isEmpty)) composeEye(part.counts, own, whole);
    return whole;
}

// The left eye comes first. The right eye wins for shared colour channels; channels of neither eye stay black.
void anaglyph(const WallComposition& wall, const std::vector<Picture>& pictures, OwnedPicture& into) {
    for (const bool right : {false, true}) {
        for (const WallPart& part : wall.parts) {
            if ((part.eye == Eye::Right) != right) continue;
            OwnedPicture whole = pictureOf(part, pictures);
            if (whole.view().empty()) continue;
            if (into.view().empty()) {
                into.resize(whole.width(), whole.height());
                std::memset(into.data(), 0, into.view().sizeBytes());
            }
            fit(whole, into.width(), into.height());
            const PixelViewport all{0, 0, whole.width(), whole.height()}, area = intersect(apply(all, part.area), all);
            const compositor::ChannelMask mask = maskOf(part.colours);
            for (int y = area.y; y < area.y + area.h; ++y) {
                const size_t at = static_cast<size_t>(area.x) * kPictureBytesPerPixel;
                compositor::maskChannelsRow(into.row(y) + at, whole.view().row(y) + at,
                                            static_cast<size_t>(area.w) * kPictureBytesPerPixel, mask);
            }
        }
    }
}

} // namespace

WallComposition compositionOf(const PassCounts& counts) {
    WallComposition wall;
    wall.stereo = counts.stereo;
    WallPart part;
    part.counts = counts;
    part.counts.stereo = StereoMode::Off;
    for (const Eye eye : eyesOf(counts.stereo)) {
        part.eye = eye;
        if (wall.stereo == StereoMode::Anaglyph)
            part.colours = {eye == Eye::Left, eye == Eye::Right, eye == Eye::Right};
        wall.parts.push_back(part);
        part.firstPicture += picturesOf(part.counts);
    }
    return wall;
}

int picturesOf(const WallComposition& wall) {
    int pictures = 0;
    for (const WallPart& part : wall.parts) pictures = std::max(pictures, part.firstPicture + picturesOf(part.counts));
    return pictures;
}

void composeWall(const WallComposition& wall, const std::vector<Picture>& pictures, OwnedPicture& into) {
    into.resize(0, 0);
    OwnedPicture eyes[2]; // left (or only) and right
    const bool two =
        std::any_of(wall.parts.begin(), wall.parts.end(), [](const WallPart& p) { return p.eye == Eye::Left; }) &&
        std::any_of(wall.parts.begin(), wall.parts.end(), [](const WallPart& p) { return p.eye == Eye::Right; });
    if (two && wall.stereo == StereoMode::Anaglyph) return anaglyph(wall, pictures, into);
    for (const WallPart& part : wall.parts) {
        OwnedPicture whole = pictureOf(part, pictures);
        if (whole.view().empty()) continue;
        const PixelViewport all{0, 0, whole.width(), whole.height()};
        const PixelViewport area = intersect(apply(all, part.area), all);
        const OwnedPicture cut = area == all ? std::move(whole) : cutOut(whole.view(), area);
        for (int eye = 0; eye < (two ? 2 : 1); ++eye) {
            if (two && part.eye == (eye == 0 ? Eye::Right : Eye::Left)) continue;
            OwnedPicture& target = eyes[eye];
            if (target.width() != all.w || target.height() != all.h) {
                target.resize(all.w, all.h);
                std::memset(target.data(), 0, target.view().sizeBytes());
            }
            copyInto(target, area.x, area.y, cut.view());
        }
    }
    if (two && !eyes[0].view().empty() && !eyes[1].view().empty()) fit(eyes[1], eyes[0].width(), eyes[0].height());
    const bool pair = two && eyes[0].width() == eyes[1].width() && eyes[0].height() == eyes[1].height();
    const EyePair both{eyes[0].view(), pair ? eyes[1].view() : eyes[0].view()};
    if (wall.stereo == StereoMode::Quad)
        stackEyes(both, into);
    else if (!pair)
        into = std::move(eyes[0]);
    else if (wall.stereo == StereoMode::TopBottom)
        topBottom(both, into);
    else
        sideBySide(both, into);
}

} // namespace mural
