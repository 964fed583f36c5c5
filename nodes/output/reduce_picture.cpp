#include "nodes/output/reduce_picture.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace mural {

namespace {

constexpr size_t kChannels = kPictureBytesPerPixel;

// Returns the first source pixel of a target pixel. The ranges of neighbours touch and cover the source.
int firstOf(int target, int targets, int sources) { return static_cast<int>(int64_t{target} * sources / targets); }

// Adds a row of the source to the sums of its columns.
void addRow(const std::byte* row, std::vector<uint32_t>& sums) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(row);
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += bytes[i];
}

void writeRow(const std::vector<uint32_t>& sums, int sourceWidth, int width, int rows, std::byte* to) {
    auto* out = reinterpret_cast<uint8_t*>(to);
    for (int x = 0; x < width; ++x) {
        const int first = firstOf(x, width, sourceWidth), end = firstOf(x + 1, width, sourceWidth);
        const auto count = static_cast<uint64_t>(end - first) * static_cast<uint64_t>(rows);
        for (size_t channel = 0; channel < kChannels; ++channel) {
            uint64_t sum = 0;
            for (int i = first; i < end; ++i) sum += sums[static_cast<size_t>(i) * kChannels + channel];
            *out++ = static_cast<uint8_t>((sum + count / 2) / count);
        }
    }
}

} // namespace

ReducedSize reducedSize(int width, int height, int maxWidth, int maxHeight) {
    if (width <= 0 || height <= 0) return {};
    if (width <= maxWidth && height <= maxHeight) return {width, height};
    const double scale = std::min(static_cast<double>(maxWidth) / width, static_cast<double>(maxHeight) / height);
    const auto reduced = [scale](int side, int most) {
        return std::clamp(static_cast<int>(side * scale + 0.5), 1, std::max(most, 1));
    };
    return {reduced(width, maxWidth), reduced(height, maxHeight)};
}

void reducePicture(const Picture& source, ReducedSize size, std::byte* to) {
    const size_t rowBytes = static_cast<size_t>(size.width) * kChannels;
    if (size.width == source.width && size.height == source.height) {
        std::memcpy(to, source.bgra, source.sizeBytes());
        return;
    }
    std::vector<uint32_t> sums(static_cast<size_t>(source.width) * kChannels);
    for (int y = 0; y < size.height; ++y) {
        const int first = firstOf(y, size.height, source.height), end = firstOf(y + 1, size.height, source.height);
        std::ranges::fill(sums, 0U);
        for (int row = first; row < end; ++row) addRow(source.row(row), sums);
        writeRow(sums, source.width, size.width, end - first, to + rowBytes * static_cast<size_t>(y));
    }
}

} // namespace mural
