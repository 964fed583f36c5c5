#include "compositor/image/region.hpp"

#include <algorithm>

namespace mural::compositor {

namespace {

// Visits the parts of `whole` outside of `hole`: below, above, left and right.
template <class Each> void cutOut(const PixelViewport& whole, const PixelViewport& hole, Each&& each) {
    const PixelViewport common = intersect(whole, hole);
    if (common.empty()) {
        each(whole);
        return;
    }
    const auto emit = [&](int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
        if (x1 > x0 && y1 > y0) each(PixelViewport{x0, y0, x1 - x0, y1 - y0});
    };
    emit(whole.x, whole.y, whole.right(), common.y);
    emit(whole.x, common.top(), whole.right(), whole.top());
    emit(whole.x, common.y, common.x, common.top());
    emit(common.right(), common.y, whole.right(), common.top());
}

} // namespace

void Region::add(const PixelViewport& area) {
    if (area.empty()) return;
    std::vector<PixelViewport> fresh{area}, next;
    for (const PixelViewport& there : rectangles_) {
        next.clear();
        for (const PixelViewport& piece : fresh)
            cutOut(piece, there, [&](const PixelViewport& r) { next.push_back(r); });
        fresh.swap(next);
        if (fresh.empty()) return;
    }
    rectangles_.insert(rectangles_.end(), fresh.begin(), fresh.end());
}

void Region::add(const Region& other) {
    for (const PixelViewport& r : other.rectangles_) add(r);
}

void Region::subtract(const PixelViewport& area) {
    std::vector<PixelViewport> left;
    for (const PixelViewport& r : rectangles_)
        cutOut(r, area, [&](const PixelViewport& piece) { left.push_back(piece); });
    rectangles_.swap(left);
}

void Region::move(int32_t dx, int32_t dy) {
    for (PixelViewport& r : rectangles_) {
        r.x += dx;
        r.y += dy;
    }
}

void Region::simplify() {
    // Merges within rows first, then equal rows: a tile grid becomes a few rectangles.
    const auto join = [&](auto before, auto follows, auto grow) {
        std::ranges::sort(rectangles_, before);
        std::vector<PixelViewport> joined;
        for (const PixelViewport& r : rectangles_) {
            if (!joined.empty() && follows(joined.back(), r))
                grow(joined.back(), r);
            else
                joined.push_back(r);
        }
        rectangles_.swap(joined);
    };
    using R = PixelViewport;
    join([](const R& a, const R& b) { return a.y != b.y   ? a.y < b.y
                                             : a.h != b.h ? a.h < b.h
                                                          : a.x < b.x; },
         [](const R& a, const R& b) { return a.y == b.y && a.h == b.h && a.right() == b.x; },
         [](R& a, const R& b) { a.w += b.w; });
    join([](const R& a, const R& b) { return a.x != b.x   ? a.x < b.x
                                             : a.w != b.w ? a.w < b.w
                                                          : a.y < b.y; },
         [](const R& a, const R& b) { return a.x == b.x && a.w == b.w && a.top() == b.y; },
         [](R& a, const R& b) { a.h += b.h; });
}

int64_t Region::area() const {
    int64_t sum = 0;
    for (const PixelViewport& r : rectangles_) sum += r.area();
    return sum;
}

PixelViewport Region::bounds() const {
    PixelViewport all;
    for (const PixelViewport& r : rectangles_) all = unite(all, r);
    return all;
}

bool Region::contains(int32_t x, int32_t y) const {
    return std::ranges::any_of(rectangles_, [&](const PixelViewport& r) { return r.contains({x, y, 1, 1}); });
}

bool Region::covers(const PixelViewport& area) const {
    int64_t common = 0;
    for (const PixelViewport& r : rectangles_) common += intersect(r, area).area();
    return common == area.area();
}

Region Region::intersected(const PixelViewport& area) const {
    Region common;
    for (const PixelViewport& r : rectangles_) {
        const PixelViewport both = intersect(r, area);
        if (!both.empty()) common.rectangles_.push_back(both);
    }
    return common;
}

Region Region::intersected(const Region& other) const {
    Region common;
    for (const PixelViewport& r : other.rectangles_) {
        const Region piece = intersected(r);
        common.rectangles_.insert(common.rectangles_.end(), piece.rectangles_.begin(), piece.rectangles_.end());
    }
    return common;
}

} // namespace mural::compositor
