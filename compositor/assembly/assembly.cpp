#include "compositor/assembly/assembly.hpp"

#include <cstring>
#include <string>

#include "compositor/kernels/blend_over.hpp"
#include "compositor/kernels/interleave_pixels.hpp"
#include "compositor/kernels/z_select.hpp"

namespace mural::compositor {

namespace {

std::string sizeText(const PlaneView& p) {
    return std::to_string(p.width) + "x" + std::to_string(p.height) + " " + nameOf(p.format);
}
std::string orderText(const DrawOrder& o) { return std::to_string(o.first) + " to " + std::to_string(o.end); }

Error mismatch(const char* what, const PlaneView& into, const PlaneView& part, const char* next) {
    return Error{std::string(what) + ": the part has " + sizeText(part) + ", the picture " + sizeText(into) + "; " +
                 next};
}

Error misplaced(const char* what, const PixelViewport& into, const PixelViewport& part) {
    const auto text = [](const PixelViewport& v) {
        return std::to_string(v.w) + "x" + std::to_string(v.h) + " at " + std::to_string(v.x) + "," +
               std::to_string(v.y);
    };
    return Error{std::string(what) + ": the drawn part " + text(part) + " is outside of the picture " + text(into) +
                 "; use the same frame of reference for both"};
}

// The drawn rectangles of `part` in the pixels of `into`, and the inverse mapping.
struct Placement {
    int32_t dx, dy;
    [[nodiscard]] PixelViewport inTarget(const PixelViewport& r) const { return {r.x + dx, r.y + dy, r.w, r.h}; }
};

Result<Placement> place(const char* what, const Image& into, const Image& part) {
    const Placement p{part.x - into.x, part.y - into.y};
    for (const PixelViewport& r : part.drawn.rectangles()) {
        PixelViewport inPicture = r;
        inPicture.x += part.x;
        inPicture.y += part.y;
        if (!into.area().contains(inPicture)) return misplaced(what, into.area(), inPicture);
    }
    return p;
}

// Records that the picture now contains both.
void take(Image& into, const Image& part, const Placement& p) {
    for (const PixelViewport& r : part.drawn.rectangles()) into.drawn.add(p.inTarget(r));
    into.drawn.simplify();
}

} // namespace

Result<void> assembleCopy(Image& into, const Image& part) {
    const char* what = "copying a part";
    auto placed = place(what, into, part);
    if (!placed) return placed.error();
    const auto copy = [&](std::optional<Plane>& to, const std::optional<Plane>& from) {
        if (!to || !from) return true;
        if (to->format() != from->format()) return false;
        for (const PixelViewport& r : part.drawn.rectangles())
            copyPlane(to->view().part(placed->inTarget(r)), from->view().part(r));
        return true;
    };
    if (!copy(into.colour, part.colour))
        return mismatch(what, into.colour->view(), part.colour->view(), "use one format for both");
    if (!copy(into.depth, part.depth))
        return mismatch(what, into.depth->view(), part.depth->view(), "use one format for both");
    take(into, part, *placed);
    return {};
}

Result<void> assembleDepth(Image& into, const Image& part, const DepthAssembly& how) {
    const char* what = "compositing by depth";
    if (!into.depth || !part.depth)
        return Error{std::string(what) + ": a picture has no depth plane; read depth back for both"};
    if (into.depth->format() != part.depth->format() || !isDepth(part.depth->format()))
        return mismatch(what, into.depth->view(), part.depth->view(), "use one depth format");
    if (into.colour.has_value() != part.colour.has_value())
        return Error{std::string(what) + ": only one of the pictures has colour; read colour back for both"};
    if (into.colour && into.colour->format() != part.colour->format())
        return mismatch(what, into.colour->view(), part.colour->view(), "use one colour format");
    if (!apart(into.order, part.order))
        return Error{std::string(what) + ": parts " + orderText(part.order) + " of the draw order lie between " +
                     orderText(into.order) + "; composite only separate ranges"};
    auto placed = place(what, into, part);
    if (!placed) return placed.error();
    DepthRule rule;
    rule.function = how.function;
    rule.format = part.depth->format() == PlaneFormat::D24S8 ? DepthFormat::D24S8 : DepthFormat::D32F;
    if (how.coverage == Coverage::Stencil && rule.format != DepthFormat::D24S8)
        return Error{std::string(what) + ": " + nameOf(part.depth->format()) +
                     " has no stencil for coverage; use D24S8"};
    rule.sourceIsLater = part.order.first >= into.order.end;
    rule.coverage = how.coverage;
    rule.clearBits = how.clearBits;
    for (const PixelViewport& r : part.drawn.rectangles()) {
        const MutablePlaneView depth = into.depth->view().part(placed->inTarget(r));
        const PlaneView sourceDepth = part.depth->view().part(r);
        ZArea area;
        area.columns = static_cast<size_t>(r.w);
        area.rows = static_cast<size_t>(r.h);
        area.depth = reinterpret_cast<uint32_t*>(depth.row(0));
        area.sourceDepth = reinterpret_cast<const uint32_t*>(sourceDepth.row(0));
        area.depthStride = depth.strideBytes;
        area.sourceDepthStride = sourceDepth.strideBytes;
        if (into.colour) {
            const MutablePlaneView colour = into.colour->view().part(placed->inTarget(r));
            const PlaneView sourceColour = part.colour->view().part(r);
            area.colourBytes = bytesPerPixel(colour.format);
            area.colour = colour.row(0);
            area.sourceColour = sourceColour.row(0);
            area.colourStride = colour.strideBytes;
            area.sourceColourStride = sourceColour.strideBytes;
        }
        zSelect(area, rule);
    }
    take(into, part, *placed);
    into.order = joined(into.order, part.order);
    return {};
}

Result<void> assembleBlended(Image& into, const Image& part) {
    const char* what = "blending";
    if (!into.colour || !part.colour)
        return Error{std::string(what) + ": a picture has no colour plane; read colour back for both"};
    if (into.colour->format() != part.colour->format())
        return mismatch(what, into.colour->view(), part.colour->view(), "use one colour format");
    if (!adjacent(into.order, part.order))
        return Error{std::string(what) + ": parts " + orderText(part.order) +
                     " of the draw order are not adjacent to " + orderText(into.order) +
                     "; blend the parts between them first"};
    auto placed = place(what, into, part);
    if (!placed) return placed.error();
    const SourceSide side = part.order.first == into.order.end ? SourceSide::InFront : SourceSide::Behind;
    for (const PixelViewport& r : part.drawn.rectangles()) {
        const MutablePlaneView to = into.colour->view().part(placed->inTarget(r));
        const PlaneView from = part.colour->view().part(r);
        for (int32_t y = 0; y < r.h; ++y)
            blendOverRow(to.format, to.row(y), from.row(y), static_cast<size_t>(r.w), side);
    }
    take(into, part, *placed);
    into.order = joined(into.order, part.order);
    return {};
}

namespace {

// Returns the number of a kernel's pixels in a row of `size`: from `first` on, every `step`.
int32_t countOf(int32_t size, int32_t first, int32_t step) {
    return first < size ? (size - first + step - 1) / step : 0;
}

// Returns the part of `part` that lies within the picture.
Result<PixelViewport> withinPicture(const PlaneView& picture, const PlaneView& part, const PixelKernel& k) {
    const char* what = "interleaving pixels";
    if (!k.valid())
        return Error{std::string(what) + ": pixel " + std::to_string(k.x) + "," + std::to_string(k.y) +
                     " is outside of a kernel of " + std::to_string(k.w) + "x" + std::to_string(k.h) +
                     "; check the compound"};
    const PixelViewport within{0, 0, countOf(picture.width, k.x, k.w), countOf(picture.height, k.y, k.h)};
    const PixelViewport maximum = apply({0, 0, picture.width, picture.height}, k);
    if (part.format != picture.format || part.width < within.w || part.height < within.h || part.width > maximum.w ||
        part.height > maximum.h)
        return Error{std::string(what) + ": the part has " + sizeText(part) + " instead of " +
                     std::to_string(within.w) + "x" + std::to_string(within.h) + " " + nameOf(picture.format) +
                     "; draw it with its kernel's size"};
    return within;
}

} // namespace

Result<void> interleavePixels(const MutablePlaneView& into, const PlaneView& part, const PixelKernel& kernel) {
    const auto within = withinPicture(into, part, kernel);
    if (!within) return within.error();
    const size_t pixel = bytesPerPixel(into.format);
    for (int32_t y = 0; y < within.value().h && within.value().w > 0; ++y)
        interleaveRow(into.row(kernel.y + y * kernel.h) + static_cast<size_t>(kernel.x) * pixel, part.row(y),
                      static_cast<size_t>(within.value().w), static_cast<size_t>(kernel.w), pixel);
    return {};
}

Result<void> deinterleavePixels(const MutablePlaneView& part, const PlaneView& from, const PixelKernel& kernel) {
    const auto within = withinPicture(from, part, kernel);
    if (!within) return within.error();
    const size_t pixel = bytesPerPixel(from.format);
    for (int32_t y = 0; y < within.value().h && within.value().w > 0; ++y)
        deinterleaveRow(part.row(y), from.row(kernel.y + y * kernel.h) + static_cast<size_t>(kernel.x) * pixel,
                        static_cast<size_t>(within.value().w), static_cast<size_t>(kernel.w), pixel);
    return {};
}

ChannelMask channelMaskOf(PlaneFormat format, const ColourMask& mask) {
    ChannelMask bytes{};
    const bool taken[4] = {mask.red, mask.green, mask.blue, mask.alpha};
    if (format == PlaneFormat::Rgb10A2) {
        const uint32_t word = (mask.red ? 0x3ffu : 0) | (mask.green ? 0x3ffu << 10 : 0) |
                              (mask.blue ? 0x3ffu << 20 : 0) | (mask.alpha ? 0x3u << 30 : 0);
        for (size_t at = 0; at < bytes.size(); at += sizeof word) std::memcpy(bytes.data() + at, &word, sizeof word);
        return bytes;
    }
    const size_t component = bytesPerPixel(format) / 4;
    for (size_t at = 0; at < bytes.size(); ++at) bytes[at] = taken[at / component % 4] ? std::byte{0xff} : std::byte{0};
    return bytes;
}

Result<void> assembleMasked(const MutablePlaneView& into, const PlaneView& part, const ColourMask& mask) {
    if (!sameShape(into, part))
        return mismatch("combining by colour mask", into, part, "draw both eyes with one size and format");
    if (isDepth(into.format))
        return Error{std::string("combining by colour mask: ") + nameOf(into.format) +
                     " has no colours; use colour planes"};
    const ChannelMask bytes = channelMaskOf(into.format, mask);
    for (int32_t y = 0; y < into.height; ++y) maskChannelsRow(into.row(y), part.row(y), into.rowBytes(), bytes);
    return {};
}

} // namespace mural::compositor
