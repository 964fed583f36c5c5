#include "compositor/kernels/z_select.hpp"

#include <cstring>

#include "compositor/kernels/ask_ahead.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/kernels/z_select.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mural::compositor::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR // no vectors: the loop behind them does all

size_t zSelectVectors(const ZRow&, const DepthRule&) { return 0; }

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

// Wide pixels: what is copied is much more than the mask, so one at a time.
template <class D> void selectWide(D du, const ZRow& row, size_t i, hn::Mask<D> win) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(du, win, bits);
    uint64_t left = 0;
    std::memcpy(&left, bits, sizeof left);
    for (; left != 0; left &= left - 1) {
        const size_t at = (i + static_cast<size_t>(__builtin_ctzll(left))) * row.colourBytes;
        if (row.colourBytes == 8) std::memcpy(row.colour + at, row.sourceColour + at, 8);
        else std::memcpy(row.colour + at, row.sourceColour + at, 16);
    }
}

// Returns how many pixels it did: whole vectors, two at once, for a line of the cache is one vector with the widest of them only.
template <SourceWins W, bool kFloat, bool kCovered> size_t selectRow(const ZRow& row, const Constants& c) {
    const hn::ScalableTag<uint32_t> du;
    const size_t lanes = hn::Lanes(du), step = 2 * lanes;
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
    const auto sourceAt = [&](size_t i) { return hn::LoadU(du, row.sourceDepth + i); };
    const auto thereAt = [&](size_t i) { return hn::LoadU(du, row.depth + i); };
    const auto select = [&](size_t i, hn::Mask<decltype(du)> win) {
        selectWords(du, row.depth + i, row.sourceDepth + i, win);
        if (!row.colour) return;
        if (row.colourBytes == 4) selectWords(du, reinterpret_cast<uint32_t*>(row.colour) + i, reinterpret_cast<const uint32_t*>(row.sourceColour) + i, win);
        else selectWide(du, row, i, win);
    };
    size_t i = 0;
    for (; i + step <= row.count; i += step) {
        askFor(row.depth + i + kAheadWords, 4 * step);
        askFor(row.sourceDepth + i + kAheadWords, 4 * step);
        const auto first = wins(sourceAt(i), thereAt(i)), second = wins(sourceAt(i + lanes), thereAt(i + lanes));
        if (hn::AllFalse(du, hn::Or(first, second))) continue;
        if (row.colour) { // where some are taken, there more will be
            askFor(row.colour + (i + kAheadWords) * row.colourBytes, step * row.colourBytes);
            askFor(row.sourceColour + (i + kAheadWords) * row.colourBytes, step * row.colourBytes);
        }
        select(i, first);
        select(i + lanes, second);
    }
    for (; i + lanes <= row.count; i += lanes) {
        const auto win = wins(sourceAt(i), thereAt(i));
        if (!hn::AllFalse(du, win)) select(i, win);
    }
    return i;
}

template <SourceWins W> size_t chooseRow(const ZRow& row, const Constants& c, bool isFloat, bool covered) {
    if (isFloat) return covered ? selectRow<W, true, true>(row, c) : selectRow<W, true, false>(row, c);
    return covered ? selectRow<W, false, true>(row, c) : selectRow<W, false, false>(row, c);
}

size_t zSelectVectors(const ZRow& row, const DepthRule& rule) {
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
    case DepthFunction::Greater: return later ? chooseRow<SourceWins::IfLess>(row, c, isFloat, covered) : chooseRow<SourceWins::IfLessOrEqual>(row, c, isFloat, covered);
    case DepthFunction::LessOrEqual:
    case DepthFunction::GreaterOrEqual: return later ? chooseRow<SourceWins::IfLessOrEqual>(row, c, isFloat, covered) : chooseRow<SourceWins::IfLess>(row, c, isFloat, covered);
    case DepthFunction::Equal: return later ? chooseRow<SourceWins::IfEqual>(row, c, isFloat, covered) : chooseRow<SourceWins::IfNotEqual>(row, c, isFloat, covered);
    case DepthFunction::NotEqual: return later ? chooseRow<SourceWins::IfNotEqual>(row, c, isFloat, covered) : chooseRow<SourceWins::IfEqual>(row, c, isFloat, covered);
    case DepthFunction::Always: return later ? chooseRow<SourceWins::Always>(row, c, isFloat, covered) : chooseRow<SourceWins::Never>(row, c, isFloat, covered);
    case DepthFunction::Never: return later ? chooseRow<SourceWins::Never>(row, c, isFloat, covered) : chooseRow<SourceWins::Always>(row, c, isFloat, covered);
    }
    return 0;
}

#endif

} // namespace mural::compositor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mural::compositor {

HWY_EXPORT(zSelectVectors);

void zSelectRow(const ZRow& row, const DepthRule& rule) {
    const size_t done = HWY_DYNAMIC_DISPATCH(zSelectVectors)(row, rule);
    ZRow rest = row;
    rest.depth += done;
    rest.sourceDepth += done;
    rest.count -= done;
    if (rest.colour) {
        rest.colour += done * row.colourBytes;
        rest.sourceColour += done * row.colourBytes;
    }
    zSelectRowScalar(rest, rule);
}

} // namespace mural::compositor
#endif
