#include "compositor/strategies/swap_groups.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>

namespace mural::compositor {

namespace {

// A rank that holds a band of its group's picture.
struct CommandFilter {
    int rank = 0;
    RowRange band;
};
using Group = std::vector<CommandFilter>; // in the order of their bands

RowRange common(const RowRange& a, const RowRange& b) { return {std::max(a.first, b.first), std::min(a.end, b.end)}; }

struct Seat {
    int group = 0;
    size_t at = 0; // in it
};

// Orders the members of all groups by the centres of their bands. The new, smaller band of each member lies in its old
// one for groups of equal size, and near it otherwise.
std::vector<Seat> seatsOf(const std::vector<Group>& groups) {
    std::vector<Seat> seats;
    for (size_t g = 0; g < groups.size(); ++g)
        for (size_t i = 0; i < groups[g].size(); ++i) seats.push_back({static_cast<int>(g), i});
    const auto before = [&](const Seat& a, const Seat& b) {
        return (2 * a.at + 1) * groups[static_cast<size_t>(b.group)].size() <
               (2 * b.at + 1) * groups[static_cast<size_t>(a.group)].size();
    };
    std::ranges::stable_sort(seats, before);
    return seats;
}

Group merge(ScheduleMaker& maker, const std::vector<Group>& groups) {
    const std::vector<Seat> seats = seatsOf(groups);
    Group merged;
    std::vector<RowTransfer> transfers;
    for (size_t s = 0; s < seats.size(); ++s) {
        const Seat& seat = seats[s];
        const CommandFilter& to = groups[static_cast<size_t>(seat.group)][seat.at];
        const RowRange band = maker.band(static_cast<int>(s), static_cast<int>(seats.size()));
        for (size_t g = 0; g < groups.size(); ++g) {
            const int distance = static_cast<int>(g) - seat.group;
            const auto kind = distance == 0  ? Step::Kind::Place
                              : distance < 0 ? Step::Kind::FoldEarlier
                                             : Step::Kind::FoldLater;
            for (const CommandFilter& from : groups[g])
                if (from.rank != to.rank)
                    transfers.push_back({from.rank, to.rank, common(from.band, band), kind, std::abs(distance)});
        }
        merged.push_back({to.rank, band});
    }
    maker.round(transfers);
    return merged;
}

Group swapped(ScheduleMaker& maker, std::span<const int> ranks, const GroupSplit& split) {
    if (ranks.size() == 1) return {{ranks.front(), maker.band(0, 1)}};
    std::vector<Group> groups;
    for (const int size : split(static_cast<int>(ranks.size()))) {
        groups.push_back(swapped(maker, ranks.first(static_cast<size_t>(size)), split));
        ranks = ranks.subspan(static_cast<size_t>(size));
    }
    return merge(maker, groups);
}

} // namespace

void swapGroups(ScheduleMaker& maker, const std::vector<int>& ranks, const GroupSplit& split) {
    const Group whole = swapped(maker, ranks, split);
    std::vector<RowTransfer> gather;
    for (const CommandFilter& h : whole)
        if (h.rank != ranks.front()) gather.push_back({h.rank, ranks.front(), h.band, Step::Kind::Place, 0});
    maker.round(gather);
}

std::vector<int> foldRemainder(ScheduleMaker& maker, int count) {
    const int remainder = maker.ranks() - count;
    std::vector<int> left;
    std::vector<RowTransfer> folds;
    for (int i = 0; i < count; ++i) {
        const int rank = i < remainder ? 2 * i : i + remainder;
        if (i < remainder) folds.push_back({rank + 1, rank, maker.band(0, 1), Step::Kind::FoldLater, 0});
        left.push_back(rank);
    }
    maker.round(folds);
    return left;
}

} // namespace mural::compositor
