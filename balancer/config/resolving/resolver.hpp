// State shared by the steps of resolve().
#pragma once

#include "balancer/config/resolve.hpp"

namespace mural::config {

struct Resolver {
    const ConfigFile& file;
    GlobalDefaults defaults;
    Diagnostics& diagnostics;
    ResolvedConfig out;

    // Returns the first element with this name, or kNone. The empty name finds unnamed elements.
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
// Returns the destination channel of a view on a segment; kNone if they do not overlap.
Index destinationChannel(const ResolvedConfig& config, Index segment, Index view);
// Creates missing destination channels of a canvas.
void addDestinationChannels(Resolver& r, Index canvas);
void resolveCompounds(Resolver& r);
// Determines the executing channel and the destination of each compound.
void linkChannels(ResolvedConfig& config);

// Steps after reading.
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
