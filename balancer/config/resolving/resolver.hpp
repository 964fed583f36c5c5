// What the steps of resolve() share.
#pragma once

#include "balancer/config/resolve.hpp"

namespace mural::config {

struct Resolver {
    const ConfigFile& file;
    GlobalDefaults defaults;
    Diagnostics& diagnostics;
    ResolvedConfig out;

    // The first element that is called so; kNone when there is none. "" is called what has no name.
    template <class T> static Index named(const std::vector<T>& all, std::string_view name) {
        for (size_t i = 0; i < all.size(); ++i) {
            if (all[i].name == name) return static_cast<Index>(i);
        }
        return kNone;
    }
    template <class T> static Index add(std::vector<T>& all, T element) {
        all.push_back(std::move(element));
        return static_cast<Index>(all.size()) - 1;
    }
    static size_t at(Index index) { return static_cast<size_t>(index); }
};

void resolveResources(Resolver& r);
void resolveDisplays(Resolver& r);
// The picture of a view on a segment; kNone when it does not fall onto it.
Index destinationChannel(const ResolvedConfig& config, Index segment, Index view);
// Makes the destination channels of a canvas that are not there yet.
void addDestinationChannels(Resolver& r, Index canvas);
void resolveCompounds(Resolver& r);
// Looks up which channels compounds draw with and for.
void linkChannels(ResolvedConfig& config);

// The steps after reading.
void useShownChannels(Resolver& r);
void addOutputCompounds(Resolver& r);
void addDestinationViews(Resolver& r);
void addDefaultObserver(Resolver& r);
void mendVersion10(Resolver& r);
void mendVersion11(Resolver& r);
void addTileQueues(Resolver& r);
void addCopies(Resolver& r);
void nameFrames(Resolver& r);

} // namespace mural::config
