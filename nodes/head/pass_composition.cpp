#include "nodes/head/pass_composition.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

namespace mural {

namespace {

uint8_t byteAt(const Picture& p, size_t i) { return std::to_integer<uint8_t>(p.bgra[i]); }

// Sums of 32 bits hold 2^24 samples; halves are rounded up.
void average(std::span<const Picture> samples, OwnedPicture& into) {
    into.assign(samples.front());
    if (samples.size() == 1) return;
    const size_t bytes = into.view().sizeBytes();
    const auto count = static_cast<uint32_t>(samples.size());
    std::vector<uint32_t> sums(bytes, count / 2);
    for (const Picture& p : samples)
        for (size_t i = 0; i < std::min(bytes, p.sizeBytes()); ++i) sums[i] += byteAt(p, i);
    for (size_t i = 0; i < bytes; ++i) into.data()[i] = static_cast<std::byte>(sums[i] / count);
}

// Kernel pixel (i, j) of each picture is pixel (i * columns + its column, j * rows + its row) of the whole.
void interleave(const PassCounts& counts, const std::vector<OwnedPicture>& parts, OwnedPicture& into) {
    const auto at = [&](int x, int y) -> const OwnedPicture& { return parts[static_cast<size_t>(y * counts.kernelWidth + x)]; };
    int width = 0, height = 0;
    for (int x = 0; x < counts.kernelWidth; ++x) width += at(x, 0).width();
    for (int y = 0; y < counts.kernelHeight; ++y) height += at(0, y).height();
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

// Red of the left eye, green and blue of the right.
void anaglyph(const Picture& left, const Picture& right, OwnedPicture& into) {
    into.assign(right);
    const size_t bytes = std::min(left.sizeBytes(), right.sizeBytes());
    for (size_t i = 2; i < bytes; i += kPictureBytesPerPixel) into.data()[i] = left.bgra[i];
}

// One dimension is halved: the mean of two neighbours, rounded up; an odd last one stands alone.
void halveInto(OwnedPicture& into, const Picture& eye, int x0, int y0, int width, int height, bool columns) {
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int ax = columns ? 2 * x : x, ay = columns ? y : 2 * y;
            const int bx = std::min(columns ? ax + 1 : ax, eye.width - 1), by = std::min(columns ? ay : ay + 1, eye.height - 1);
            const std::byte* a = eye.row(ay) + static_cast<size_t>(ax) * kPictureBytesPerPixel;
            const std::byte* b = eye.row(by) + static_cast<size_t>(bx) * kPictureBytesPerPixel;
            std::byte* to = into.row(y0 + y) + static_cast<size_t>(x0 + x) * kPictureBytesPerPixel;
            for (size_t i = 0; i < kPictureBytesPerPixel; ++i)
                to[i] = static_cast<std::byte>((std::to_integer<int>(a[i]) + std::to_integer<int>(b[i]) + 1) / 2);
        }
    }
}

void sideBySide(const Picture& left, const Picture& right, OwnedPicture& into) {
    into.resize(left.width, left.height);
    const int half = (left.width + 1) / 2;
    halveInto(into, left, 0, 0, half, left.height, true);
    halveInto(into, right, half, 0, left.width - half, left.height, true);
}

void topBottom(const Picture& left, const Picture& right, OwnedPicture& into) {
    into.resize(left.width, left.height);
    const int half = (left.height + 1) / 2; // the upper part, of the left eye
    halveInto(into, right, 0, 0, left.width, left.height - half, false);
    halveInto(into, left, 0, left.height - half, left.width, half, false);
}

} // namespace

void composePasses(const PassCounts& counts, const std::vector<Picture>& passes, OwnedPicture& into) {
    into.resize(0, 0);
    const bool empty = std::any_of(passes.begin(), passes.end(), [](const Picture& p) { return p.empty(); });
    if (empty || passes.size() != static_cast<size_t>(picturesOf(counts))) return;
    const auto kernels = static_cast<size_t>(counts.kernelWidth * counts.kernelHeight);
    const size_t eyes = eyesOf(counts.stereo).size();
    std::vector<OwnedPicture> eyePictures(eyes);
    size_t at = 0;
    for (OwnedPicture& eye : eyePictures) {
        std::vector<OwnedPicture> parts(kernels);
        for (OwnedPicture& part : parts) {
            average(std::span(passes).subspan(at, static_cast<size_t>(counts.samples)), part);
            at += static_cast<size_t>(counts.samples);
        }
        if (kernels == 1) eye = std::move(parts.front());
        else interleave(counts, parts, eye);
    }
    if (eyes == 1) into = std::move(eyePictures.front());
    else if (counts.stereo == StereoMode::Anaglyph) anaglyph(eyePictures[0].view(), eyePictures[1].view(), into);
    else if (counts.stereo == StereoMode::TopBottom) topBottom(eyePictures[0].view(), eyePictures[1].view(), into);
    else sideBySide(eyePictures[0].view(), eyePictures[1].view(), into);
}

} // namespace mural
