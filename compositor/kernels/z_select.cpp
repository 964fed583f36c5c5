#include "compositor/kernels/z_select.hpp"

#include <cstring>
#include <hwy/cache_control.h>

#include "compositor/kernels/prefetch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/z_select.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void zSelectVectors(const ZArea& area, const DepthRule& rule) { zSelectScalar(area, rule); }

#else

namespace hn = hwy::HWY_NAMESPACE;

// Reduction of eight functions and two orders: `later FUNCTION earlier` for a later source, and the negation for an
// earlier one, where NaN loses to any number.
enum class SourceWins { Never, IfLess, IfLessOrEqual, IfGreater, IfGreaterOrEqual, IfEqual, IfNotEqual, Always };

struct Constants {
    uint32_t clear; // drawn: (depth ^ clear) & drawnMask != 0
    uint32_t drawnMask;
};

constexpr SourceWins contraryOf(SourceWins w) {
    switch (w) {
    case SourceWins::IfLess: return SourceWins::IfGreaterOrEqual;
    case SourceWins::IfLessOrEqual: return SourceWins::IfGreater;
    case SourceWins::IfGreater: return SourceWins::IfLessOrEqual;
    default: return SourceWins::IfLess;
    }
}

template <SourceWins W, class D> auto wins24(D du, hn::Vec<D> source, hn::Vec<D> there) {
    const hn::RebindToSigned<D> di; // 24 bits: signed comparisons suffice
    const auto s = hn::BitCast(di, hn::ShiftRight<8>(source));
    const auto t = hn::BitCast(di, hn::ShiftRight<8>(there));
    if constexpr (W == SourceWins::IfLess)
        return hn::RebindMask(du, hn::Lt(s, t));
    else if constexpr (W == SourceWins::IfLessOrEqual)
        return hn::RebindMask(du, hn::Not(hn::Gt(s, t)));
    else if constexpr (W == SourceWins::IfGreater)
        return hn::RebindMask(du, hn::Gt(s, t));
    else if constexpr (W == SourceWins::IfGreaterOrEqual)
        return hn::RebindMask(du, hn::Not(hn::Lt(s, t)));
    else if constexpr (W == SourceWins::IfEqual)
        return hn::RebindMask(du, hn::Eq(s, t));
    else
        return hn::RebindMask(du, hn::Not(hn::Eq(s, t)));
}

template <SourceWins W, class V> auto ordered(V s, V t) {
    if constexpr (W == SourceWins::IfLess)
        return hn::Lt(s, t);
    else if constexpr (W == SourceWins::IfLessOrEqual)
        return hn::Le(s, t);
    else if constexpr (W == SourceWins::IfGreater)
        return hn::Gt(s, t);
    else
        return hn::Ge(s, t);
}

// A later number replaces NaN: it wins unless the negation holds, which is false for NaN. An earlier source replaces
// every NaN.
template <SourceWins W, bool kLater, class D> auto winsFloat(D du, hn::Vec<D> source, hn::Vec<D> there) {
    const hn::RebindToFloat<D> df;
    const auto s = hn::BitCast(df, source);
    const auto t = hn::BitCast(df, there);
    if constexpr (W == SourceWins::IfEqual)
        return hn::RebindMask(du, hn::Eq(s, t));
    else if constexpr (W == SourceWins::IfNotEqual)
        return hn::RebindMask(du, hn::Not(hn::Eq(s, t)));
    else if constexpr (kLater) {
        return hn::RebindMask(du, hn::AndNot(ordered<contraryOf(W)>(s, t), hn::Eq(s, s)));
    } else {
        return hn::RebindMask(du, hn::Or(ordered<W>(s, t), hn::Not(hn::Eq(t, t))));
    }
}

template <class D> void selectWords(D du, uint32_t* to, const uint32_t* source, hn::Mask<D> win) {
    hn::StoreU(hn::IfThenElse(win, hn::LoadU(du, source), hn::LoadU(du, to)), du, to);
}

// Depths are read sequentially, with hardware prefetch. The needed colours follow from them, in pieces shorter than the
// memory latency, so colours are prefetched for pairs of vectors with winners, and copied when kWaiting pairs have
// accumulated.
constexpr size_t kWaiting = 16;

// Size from which colours exceed a core's caches: fully won pairs are then written with streaming stores, without
// reading the destination.
constexpr size_t kPastCachesBytes = size_t{2} << 20;

// Wide pixels are copied one at a time: the copy dominates the mask.
template <size_t kBytes, class D> void takeWide(D du, std::byte* colour, const std::byte* source, hn::Mask<D> win) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(du, win, bits);
    uint64_t left = 0;
    std::memcpy(&left, bits, sizeof left);
    for (; left != 0; left &= left - 1) {
        const size_t at = static_cast<size_t>(__builtin_ctzll(left)) * kBytes;
        std::memcpy(colour + at, source + at, kBytes);
    }
}

template <class D>
void takeColours(D du, std::byte* colour, const std::byte* source, size_t colourBytes, hn::Mask<D> win) {
    if (colourBytes == 4)
        selectWords(du, reinterpret_cast<uint32_t*>(colour), reinterpret_cast<const uint32_t*>(source), win);
    else if (colourBytes == 8)
        takeWide<8>(du, colour, source, win);
    else
        takeWide<16>(du, colour, source, win);
}

// Two vectors per step, since a cache line is one vector only with the widest of them; then single vectors, and the
// rest pixel by pixel.
template <SourceWins W, bool kLater, bool kFloat, bool kCovered, bool kWords>
void selectRows(const ZArea& area, const DepthRule& rule, const Constants& c) {
    const size_t colourBytes = kWords ? 4 : area.colourBytes;
    const hn::ScalableTag<uint32_t> du;
    const size_t lanes = hn::Lanes(du), pair = 2 * lanes;
    const auto clear = hn::Set(du, c.clear);
    const auto drawnMask = hn::Set(du, c.drawnMask);
    const auto zero = hn::Zero(du);
    const auto wins = [&](hn::Vec<decltype(du)> source, hn::Vec<decltype(du)> there) {
        auto win = hn::Eq(zero, zero);
        if constexpr (W == SourceWins::Never)
            win = hn::Not(win);
        else if constexpr (W != SourceWins::Always) {
            if constexpr (kFloat)
                win = winsFloat<W, kLater>(du, source, there);
            else
                win = wins24<W>(du, source, there);
        }
        if constexpr (kCovered) {
            const auto sourceUndrawn = hn::Eq(hn::And(hn::Xor(source, clear), drawnMask), zero);
            const auto thereUndrawn = hn::Eq(hn::And(hn::Xor(there, clear), drawnMask), zero);
            win = hn::AndNot(sourceUndrawn, hn::Or(win, thereUndrawn));
        }
        return win;
    };
    const bool pastCaches =
        kWords && area.colour && area.rows * area.columns * colourBytes >= kPastCachesBytes &&
        (reinterpret_cast<uintptr_t>(area.colour) | static_cast<uintptr_t>(area.colourStride)) % (4 * lanes) == 0;
    HWY_ALIGN uint32_t waitingWins[kWaiting * 2 * hn::MaxLanes(du)];
    std::byte* waitingColours[kWaiting];
    const std::byte* waitingSources[kWaiting];
    bool waitingWhole[kWaiting]; // fully won pairs, written with streaming stores
    size_t found = 0;
    const auto take = [&](size_t slot) {
        std::byte* colour = waitingColours[slot];
        const std::byte* source = waitingSources[slot];
        if (kWords && waitingWhole[slot]) {
            hn::Stream(hn::LoadU(du, reinterpret_cast<const uint32_t*>(source)), du,
                       reinterpret_cast<uint32_t*>(colour));
            hn::Stream(hn::LoadU(du, reinterpret_cast<const uint32_t*>(source) + lanes), du,
                       reinterpret_cast<uint32_t*>(colour) + lanes);
            return;
        }
        const uint32_t* win = waitingWins + slot * pair;
        takeColours(du, colour, source, colourBytes, hn::MaskFromVec(hn::Load(du, win)));
        takeColours(du, colour + lanes * colourBytes, source + lanes * colourBytes, colourBytes,
                    hn::MaskFromVec(hn::Load(du, win + lanes)));
    };
    for (size_t y = 0; y < area.rows; ++y) {
        const ZArea row = area.row(y);
        uint32_t* const depth = row.depth;
        const uint32_t* const sourceDepth = row.sourceDepth;
        std::byte* const colour = row.colour;
        const std::byte* const sourceColour = row.sourceColour;
        const size_t columns = row.columns;
        size_t i = 0;
        for (; i + pair <= columns; i += pair) {
            const auto source0 = hn::LoadU(du, sourceDepth + i), source1 = hn::LoadU(du, sourceDepth + i + lanes);
            const auto there0 = hn::LoadU(du, depth + i), there1 = hn::LoadU(du, depth + i + lanes);
            const auto win0 = wins(source0, there0), win1 = wins(source1, there1);
            if (hn::AllFalse(du, hn::Or(win0, win1))) continue;
            hn::StoreU(hn::IfThenElse(win0, source0, there0), du, depth + i);
            hn::StoreU(hn::IfThenElse(win1, source1, there1), du, depth + i + lanes);
            if (!colour) continue;
            const size_t slot = found % kWaiting;
            if (found >= kWaiting) take(slot);
            ++found;
            const bool whole = pastCaches && hn::AllTrue(du, hn::And(win0, win1));
            waitingWhole[slot] = whole;
            hn::Store(hn::VecFromMask(du, win0), du, waitingWins + slot * pair);
            hn::Store(hn::VecFromMask(du, win1), du, waitingWins + slot * pair + lanes);
            waitingColours[slot] = colour + i * colourBytes;
            waitingSources[slot] = sourceColour + i * colourBytes;
            if (!whole) prefetch(colour + i * colourBytes, pair * colourBytes);
            prefetch(sourceColour + i * colourBytes, pair * colourBytes);
        }
        if (i + lanes <= columns) {
            const auto source0 = hn::LoadU(du, sourceDepth + i), there0 = hn::LoadU(du, depth + i);
            const auto win = wins(source0, there0);
            hn::StoreU(hn::IfThenElse(win, source0, there0), du, depth + i);
            if (colour) takeColours(du, colour + i * colourBytes, sourceColour + i * colourBytes, colourBytes, win);
            i += lanes;
        }
        if (i < columns) zSelectScalar(row.from(i), rule);
    }
    for (size_t k = found > kWaiting ? found - kWaiting : 0; k < found; ++k) take(k % kWaiting);
    if (pastCaches) hwy::FlushStream();
}

template <SourceWins W, bool kLater, bool kFloat>
void chooseRows(const ZArea& area, const DepthRule& rule, const Constants& c) {
    if (area.colourBytes == 4)
        return rule.coverage != Coverage::All ? selectRows<W, kLater, kFloat, true, true>(area, rule, c)
                                              : selectRows<W, kLater, kFloat, false, true>(area, rule, c);
    return rule.coverage != Coverage::All ? selectRows<W, kLater, kFloat, true, false>(area, rule, c)
                                          : selectRows<W, kLater, kFloat, false, false>(area, rule, c);
}

// For order functions on floats the draw order matters.
template <SourceWins W> void choose(const ZArea& area, const DepthRule& rule, const Constants& c) {
    constexpr bool kOrders = W == SourceWins::IfLess || W == SourceWins::IfLessOrEqual || W == SourceWins::IfGreater ||
                             W == SourceWins::IfGreaterOrEqual;
    if (rule.format == DepthFormat::D24S8) return chooseRows<W, true, false>(area, rule, c);
    if constexpr (kOrders) {
        if (!rule.sourceIsLater) return chooseRows<W, false, true>(area, rule, c);
    }
    chooseRows<W, true, true>(area, rule, c);
}

void zSelectVectors(const ZArea& area, const DepthRule& rule) {
    Constants c{};
    c.clear = rule.coverage == Coverage::NotClear ? rule.clearBits : 0;
    c.drawnMask = rule.coverage == Coverage::Stencil ? 0xffu
                  : rule.format == DepthFormat::D32F ? 0xffffffffu
                                                     : 0xffffff00u;
    const bool later = rule.sourceIsLater;
    switch (rule.function) {
    case DepthFunction::Less:
        return later ? choose<SourceWins::IfLess>(area, rule, c) : choose<SourceWins::IfLessOrEqual>(area, rule, c);
    case DepthFunction::LessOrEqual:
        return later ? choose<SourceWins::IfLessOrEqual>(area, rule, c) : choose<SourceWins::IfLess>(area, rule, c);
    case DepthFunction::Greater:
        return later ? choose<SourceWins::IfGreater>(area, rule, c)
                     : choose<SourceWins::IfGreaterOrEqual>(area, rule, c);
    case DepthFunction::GreaterOrEqual:
        return later ? choose<SourceWins::IfGreaterOrEqual>(area, rule, c)
                     : choose<SourceWins::IfGreater>(area, rule, c);
    case DepthFunction::Equal:
        return later ? choose<SourceWins::IfEqual>(area, rule, c) : choose<SourceWins::IfNotEqual>(area, rule, c);
    case DepthFunction::NotEqual:
        return later ? choose<SourceWins::IfNotEqual>(area, rule, c) : choose<SourceWins::IfEqual>(area, rule, c);
    case DepthFunction::Always:
        return later ? choose<SourceWins::Always>(area, rule, c) : choose<SourceWins::Never>(area, rule, c);
    case DepthFunction::Never:
        return later ? choose<SourceWins::Never>(area, rule, c) : choose<SourceWins::Always>(area, rule, c);
    }
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(zSelectVectors);

void zSelect(const ZArea& area, const DepthRule& rule) { HWY_DYNAMIC_DISPATCH(zSelectVectors)(area, rule); }

} // namespace mural::compositor
#endif
