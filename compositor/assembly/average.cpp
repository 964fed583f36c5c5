#include "compositor/assembly/average.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "compositor/kernels/average_sums.hpp"
#include "compositor/kernels/half_float.hpp"

namespace mural::compositor {

namespace {

constexpr uint32_t kMaxFloats = 8192;
constexpr unsigned kShift10[4] = {0, 10, 20, 30};
constexpr uint32_t kMask10[4] = {1023, 1023, 1023, 3};

} // namespace

Average::Average(PlaneFormat format, int32_t width, int32_t height)
    : shape_{format, width, height, 0, nullptr}, rowComponents_(4 * static_cast<size_t>(width)) {
    const size_t components = rowComponents_ * static_cast<size_t>(height);
    if (format == PlaneFormat::Rgba8) sums16_.resize(components);
    if (format == PlaneFormat::Rgb10A2) wide_.resize(components);
    if (format == PlaneFormat::Rgba16F) floats_.resize(components);
    if (format == PlaneFormat::Rgba32F) doubles_.resize(components);
}

uint32_t Average::maximum() const {
    if (shape_.format == PlaneFormat::Rgba8) return kMaxAveraged8;
    return shape_.format == PlaneFormat::Rgb10A2 ? kMaxAveraged10 : kMaxFloats;
}

void Average::clear() {
    count_ = in16Bits_ = 0;
    std::ranges::fill(sums16_, uint16_t{0});
    std::ranges::fill(wide_, 0u);
    std::ranges::fill(floats_, 0.0f);
    std::ranges::fill(doubles_, 0.0);
}

// RGBA8: moves the 16-bit sums to 32 bits.
void Average::widen() {
    wide_.resize(sums16_.size());
    for (size_t i = 0; i < sums16_.size(); ++i) wide_[i] += sums16_[i];
    std::ranges::fill(sums16_, uint16_t{0});
    in16Bits_ = 0;
}

Result<void> Average::add(const PlaneView& picture) {
    if (!sameShape(shape_, picture) || isDepth(picture.format))
        return Error{"averaging: a picture of " + std::to_string(picture.width) + "x" + std::to_string(picture.height) +
                     " " + nameOf(picture.format) + " among " + std::to_string(shape_.width) + "x" +
                     std::to_string(shape_.height) + " " + nameOf(shape_.format) +
                     "; draw all of them with one size and format"};
    if (count_ >= maximum())
        return Error{"averaging: " + std::to_string(count_) +
                     " pictures are the maximum of a sum; write the average and restart"};
    if (in16Bits_ == kMaxIn16Bits) widen();
    for (int32_t y = 0; y < picture.height; ++y) {
        const std::byte* from = picture.row(y);
        const size_t at = rowComponents_ * static_cast<size_t>(y);
        switch (picture.format) {
        case PlaneFormat::Rgba8:
            addToSums(sums16_.data() + at, reinterpret_cast<const uint8_t*>(from), rowComponents_);
            break;
        case PlaneFormat::Rgb10A2:
            for (size_t i = 0; i < rowComponents_; i += 4) {
                uint32_t word;
                std::memcpy(&word, from + i, sizeof word);
                for (size_t c = 0; c < 4; ++c) wide_[at + i + c] += word >> kShift10[c] & kMask10[c];
            }
            break;
        case PlaneFormat::Rgba16F:
            for (size_t i = 0; i < rowComponents_; ++i)
                floats_[at + i] += floatOfHalf(reinterpret_cast<const uint16_t*>(from)[i]);
            break;
        case PlaneFormat::Rgba32F:
            for (size_t i = 0; i < rowComponents_; ++i) doubles_[at + i] += reinterpret_cast<const float*>(from)[i];
            break;
        default: break;
        }
    }
    ++count_;
    if (picture.format == PlaneFormat::Rgba8) ++in16Bits_;
    return {};
}

Result<void> Average::write(const MutablePlaneView& into) const {
    if (!sameShape(shape_, into))
        return Error{"averaging: the result has another size or format; use a plane of the same shape"};
    if (count_ == 0) return Error{"averaging: there is no picture yet; add one before the average is written"};
    std::vector<uint32_t> sums(shape_.format == PlaneFormat::Rgba8 && !wide_.empty() ? rowComponents_ : 0);
    for (int32_t y = 0; y < into.height; ++y) {
        std::byte* to = into.row(y);
        const size_t at = rowComponents_ * static_cast<size_t>(y);
        switch (into.format) {
        case PlaneFormat::Rgba8:
            for (size_t i = 0; i < sums.size(); ++i) sums[i] = wide_[at + i] + sums16_[at + i];
            if (sums.empty())
                averageOfSums(reinterpret_cast<uint8_t*>(to), sums16_.data() + at, rowComponents_, count_);
            else
                averageOfSums(reinterpret_cast<uint8_t*>(to), sums.data(), rowComponents_, count_);
            break;
        case PlaneFormat::Rgb10A2:
            for (size_t i = 0; i < rowComponents_; i += 4) {
                uint32_t word = 0;
                for (size_t c = 0; c < 4; ++c) word |= (wide_[at + i + c] + count_ / 2) / count_ << kShift10[c];
                std::memcpy(to + i, &word, sizeof word);
            }
            break;
        case PlaneFormat::Rgba16F:
            for (size_t i = 0; i < rowComponents_; ++i)
                reinterpret_cast<uint16_t*>(to)[i] = halfOfFloat(floats_[at + i] / static_cast<float>(count_));
            break;
        case PlaneFormat::Rgba32F:
            for (size_t i = 0; i < rowComponents_; ++i)
                reinterpret_cast<float*>(to)[i] = static_cast<float>(doubles_[at + i] / count_);
            break;
        default: break;
        }
    }
    return {};
}

} // namespace mural::compositor
