#include "compositor/kernels/z_select.hpp"

#include <cstring>
#include <hwy/cache_control.h>

#include "compositor/kernels/ask_ahead.hpp"

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

// What is left of the eight functions and two orders: greater is less of what `flip` has turned round, and a source that is
// earlier wins where the other one fails.
enum class SourceWins { Never, IfLess, IfLessOrEqual, IfEqual, IfNotEqual, Always };

struct Constants {
    uint32_t flip;      // turns the order round, or 0
    uint32_t clear;     // drawn: (depth ^ clear) & drawnMask is not 0
    uint32_t drawnMask;
    bool earlierSource;
};

template <SourceWins W, class D> auto wins24(D du, hn::Vec<D> source, hn::Vec<D> there, hn::Vec<D> flip) {
    const hn::RebindToSigned<D> di; // 24 bits: signed comparisons do
    const auto s = hn::BitCast(di, hn::ShiftRight<8>(hn::Xor(source, flip)));
    const auto t = hn::BitCast(di, hn::ShiftRight<8>(hn::Xor(there, flip)));
    if constexpr (W == SourceWins::IfLess) return hn::RebindMask(du, hn::Lt(s, t));
    else if constexpr (W == SourceWins::IfLessOrEqual) return hn::RebindMask(du, hn::Not(hn::Lt(t, s)));
    else if constexpr (W == SourceWins::IfEqual) return hn::RebindMask(du, hn::Eq(s, t));
    else return hn::RebindMask(du, hn::Not(hn::Eq(s, t)));
}

template <SourceWins W, class D> auto winsFloat(D du, hn::Vec<D> source, hn::Vec<D> there, hn::Vec<D> flip, hn::Mask<D> earlierSource) {
    const hn::RebindToFloat<D> df;
    const auto s = hn::BitCast(df, hn::Xor(source, flip));
    const auto t = hn::BitCast(df, hn::Xor(there, flip));
    if constexpr (W == SourceWins::IfEqual) return hn::RebindMask(du, hn::Eq(s, t));
    else if constexpr (W == SourceWins::IfNotEqual) return hn::RebindMask(du, hn::Not(hn::Eq(s, t)));
    else {
        const auto sourceIsNumber = hn::RebindMask(du, hn::Eq(s, s));
        const auto thereIsNan = hn::RebindMask(du, hn::Not(hn::Eq(t, t)));
        const auto replacesNan = hn::And(thereIsNan, hn::Or(earlierSource, sourceIsNumber));
        if constexpr (W == SourceWins::IfLess) return hn::Or(hn::RebindMask(du, hn::Lt(s, t)), replacesNan);
        else return hn::Or(hn::RebindMask(du, hn::Le(s, t)), replacesNan);
    }
}

template <class D> void selectWords(D du, uint32_t* to, const uint32_t* source, hn::Mask<D> win) {
    hn::StoreU(hn::IfThenElse(win, hn::LoadU(du, source), hn::LoadU(du, to)), du, to);
}

// Depths are read one after the other, which the hardware's own looking ahead serves well; which colours are needed is known
// from them only, in pieces shorter than memory's latency. So colours are asked for where the source wins some of two vectors
// of pixels, and taken when as many other pairs as this have been found.
constexpr size_t kWaiting = 16;

// Colours of areas from this size on are more than what a core has of the caches: where the source wins all of a pair, they are
// written past these, without reading first what was there.
constexpr size_t kPastCachesBytes = size_t{2} << 20;

// Wide pixels: what is copied is much more than the mask, so one at a time.
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

template <class D> void takeColours(D du, std::byte* colour, const std::byte* source, size_t colourBytes, hn::Mask<D> win) {
    if (colourBytes == 4) selectWords(du, reinterpret_cast<uint32_t*>(colour), reinterpret_cast<const uint32_t*>(source), win);
    else if (colourBytes == 8) takeWide<8>(du, colour, source, win);
    else takeWide<16>(du, colour, source, win);
}

// Whole vectors of each row, two at once, for a line of the cache is one vector with the widest of them only; the rest of the
// row pixel by pixel.
template <SourceWins W, bool kFloat, bool kCovered, bool kWords> void selectRows(const ZArea& area, const DepthRule& rule, const Constants& c) {
    const size_t colourBytes = kWords ? 4 : area.colourBytes;
    const hn::ScalableTag<uint32_t> du;
    const size_t lanes = hn::Lanes(du), pair = 2 * lanes;
    const auto flip = hn::Set(du, c.flip);
    const auto clear = hn::Set(du, c.clear);
    const auto drawnMask = hn::Set(du, c.drawnMask);
    const auto zero = hn::Zero(du);
    const auto all = hn::Eq(zero, zero);
    const auto earlierSource = c.earlierSource ? all : hn::Not(all);
    const auto wins = [&](hn::Vec<decltype(du)> source, hn::Vec<decltype(du)> there) {
        auto win = all;
        if constexpr (W == SourceWins::Never) win = hn::Not(all);
        else if constexpr (W != SourceWins::Always) {
            if constexpr (kFloat) win = winsFloat<W>(du, source, there, flip, earlierSource);
            else win = wins24<W>(du, source, there, flip);
        }
        if constexpr (kCovered) {
            const auto sourceDrawn = hn::Not(hn::Eq(hn::And(hn::Xor(source, clear), drawnMask), zero));
            const auto thereUndrawn = hn::Eq(hn::And(hn::Xor(there, clear), drawnMask), zero);
            win = hn::And(sourceDrawn, hn::Or(win, thereUndrawn));
        }
        return win;
    };
    const bool pastCaches = kWords && area.rows * area.columns * colourBytes >= kPastCachesBytes;
    HWY_ALIGN uint32_t waitingWins[kWaiting * 2 * hn::MaxLanes(du)];
    std::byte* waitingColours[kWaiting];
    const std::byte* waitingSources[kWaiting];
    size_t found = 0;
    const auto take = [&](size_t slot) {
        const auto win0 = hn::MaskFromVec(hn::Load(du, waitingWins + slot * pair)), win1 = hn::MaskFromVec(hn::Load(du, waitingWins + slot * pair + lanes));
        std::byte* colour = waitingColours[slot];
        const std::byte* source = waitingSources[slot];
        if (pastCaches && reinterpret_cast<uintptr_t>(colour) % (4 * lanes) == 0 && hn::AllTrue(du, hn::And(win0, win1))) {
            hn::Stream(hn::LoadU(du, reinterpret_cast<const uint32_t*>(source)), du, reinterpret_cast<uint32_t*>(colour));
            hn::Stream(hn::LoadU(du, reinterpret_cast<const uint32_t*>(source) + lanes), du, reinterpret_cast<uint32_t*>(colour) + lanes);
            return;
        }
        takeColours(du, colour, source, colourBytes, win0);
        takeColours(du, colour + lanes * colourBytes, source + lanes * colourBytes, colourBytes, win1);
    };
    for (size_t y = 0; y < area.rows; ++y) {
        ZArea row = area.row(y);
        size_t i = 0;
        for (; i + pair <= row.columns; i += pair) {
            const auto source0 = hn::LoadU(du, row.sourceDepth + i), source1 = hn::LoadU(du, row.sourceDepth + i + lanes);
            const auto there0 = hn::LoadU(du, row.depth + i), there1 = hn::LoadU(du, row.depth + i + lanes);
            const auto win0 = wins(source0, there0), win1 = wins(source1, there1);
            if (hn::AllFalse(du, hn::Or(win0, win1))) continue;
            hn::StoreU(hn::IfThenElse(win0, source0, there0), du, row.depth + i);
            hn::StoreU(hn::IfThenElse(win1, source1, there1), du, row.depth + i + lanes);
            if (!row.colour) continue;
            const size_t slot = found % kWaiting;
            if (found >= kWaiting) take(slot);
            ++found;
            hn::Store(hn::VecFromMask(du, win0), du, waitingWins + slot * pair);
            hn::Store(hn::VecFromMask(du, win1), du, waitingWins + slot * pair + lanes);
            waitingColours[slot] = row.colour + i * colourBytes;
            waitingSources[slot] = row.sourceColour + i * colourBytes;
            if (!pastCaches || !hn::AllTrue(du, hn::And(win0, win1))) askFor(waitingColours[slot], pair * colourBytes);
            askFor(waitingSources[slot], pair * colourBytes);
        }
        row.depth += i;
        row.sourceDepth += i;
        row.columns -= i;
        if (row.colour) {
            row.colour += i * colourBytes;
            row.sourceColour += i * colourBytes;
        }
        zSelectScalar(row, rule);
    }
    for (size_t k = found > kWaiting ? found - kWaiting : 0; k < found; ++k) take(k % kWaiting);
    if (pastCaches) hwy::FlushStream();
}

template <SourceWins W, bool kFloat, bool kCovered> void chooseColours(const ZArea& area, const DepthRule& rule, const Constants& c) {
    area.colourBytes == 4 ? selectRows<W, kFloat, kCovered, true>(area, rule, c) : selectRows<W, kFloat, kCovered, false>(area, rule, c);
}

template <SourceWins W> void choose(const ZArea& area, const DepthRule& rule, const Constants& c, bool covered) {
    if (rule.format == DepthFormat::D32F) return covered ? chooseColours<W, true, true>(area, rule, c) : chooseColours<W, true, false>(area, rule, c);
    return covered ? chooseColours<W, false, true>(area, rule, c) : chooseColours<W, false, false>(area, rule, c);
}

void zSelectVectors(const ZArea& area, const DepthRule& rule) {
    const bool isFloat = rule.format == DepthFormat::D32F;
    const bool greater = rule.function == DepthFunction::Greater || rule.function == DepthFunction::GreaterOrEqual;
    Constants c{};
    c.flip = !greater ? 0 : isFloat ? 0x80000000u : 0xffffffffu;
    c.clear = rule.coverage == Coverage::NotClear ? rule.clearBits : 0;
    c.drawnMask = rule.coverage == Coverage::Stencil ? 0xffu : isFloat ? 0xffffffffu : 0xffffff00u;
    c.earlierSource = !rule.sourceIsLater;
    const bool covered = rule.coverage != Coverage::All;
    const bool later = rule.sourceIsLater;
    switch (rule.function) {
    case DepthFunction::Less:
    case DepthFunction::Greater: return later ? choose<SourceWins::IfLess>(area, rule, c, covered) : choose<SourceWins::IfLessOrEqual>(area, rule, c, covered);
    case DepthFunction::LessOrEqual:
    case DepthFunction::GreaterOrEqual: return later ? choose<SourceWins::IfLessOrEqual>(area, rule, c, covered) : choose<SourceWins::IfLess>(area, rule, c, covered);
    case DepthFunction::Equal: return later ? choose<SourceWins::IfEqual>(area, rule, c, covered) : choose<SourceWins::IfNotEqual>(area, rule, c, covered);
    case DepthFunction::NotEqual: return later ? choose<SourceWins::IfNotEqual>(area, rule, c, covered) : choose<SourceWins::IfEqual>(area, rule, c, covered);
    case DepthFunction::Always: return later ? choose<SourceWins::Always>(area, rule, c, covered) : choose<SourceWins::Never>(area, rule, c, covered);
    case DepthFunction::Never: return later ? choose<SourceWins::Never>(area, rule, c, covered) : choose<SourceWins::Always>(area, rule, c, covered);
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
