// Sort-last compositing by 2 to 16 processes on this machine, Mural's and IceT's. Each rank has drawn another scene,
// and the first rank ends with the result of a depth test. Measures CPU time of the processes and transferred bytes.
#include <algorithm>
#include <cmath>
#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "nodes/exchange/picture_composer.hpp"
#include "tools/bench/icet_ranks.h"
#include "tools/bench/picture/benches.hpp"
#include "tools/bench/picture/rank_links.hpp"

namespace mural::bench {

using namespace compositor;

namespace {

constexpr uint64_t kPartTag = 1;
constexpr CompositeRule kRule{DepthFunction::Less, 0, 0xffffffffu, false};
constexpr size_t kMaxRanks = 16;
constexpr int kWarmFrames = 4; // the codec selector explores

struct Drawn {
    PicturePart part;
    std::vector<float> depth; // the same as floats, for IceT
};

struct ChosenFilter {
    const char* name;
    Strategy strategy;
    int icetStrategy; // -1: no equivalent
};
constexpr ChosenFilter kWays[] = {{"serial", Strategy::Serial, ICET_WAY_SERIAL},
                                  {"direct send", Strategy::DirectSend, ICET_WAY_DIRECT_SEND},
                                  {"binary swap", Strategy::BinarySwap, ICET_WAY_SWAP},
                                  {"radix-k", Strategy::RadixK, ICET_WAY_RADIX_K},
                                  {"streaming", Strategy::Streaming, -1}};

// Final report of a rank.
struct RankResult {
    int64_t cpuNs = 0;
    uint64_t bytes = 0;
    int64_t wrong = 0; // wrong pixels; first rank only
};

std::vector<Drawn> drawnOf(const std::vector<NamedPlane>& planes) {
    std::vector<Drawn> all;
    for (const NamedPlane& colour : planes) {
        if (colour.plane.format() != PlaneFormat::Rgba8) continue;
        const std::string stem = colour.name.substr(0, colour.name.find('.'));
        const auto depth = std::ranges::find_if(planes, [&](const NamedPlane& p) {
            return p.plane.format() == PlaneFormat::D24S8 && p.name.substr(0, p.name.find('.')) == stem;
        });
        if (depth == planes.end() || depth->plane.width() != colour.plane.width() ||
            depth->plane.height() != colour.plane.height())
            continue;
        if (!all.empty() &&
            (all[0].part.id.box.w != colour.plane.width() || all[0].part.id.box.h != colour.plane.height()))
            continue;
        Drawn d;
        d.part.id = {0, 1, {0, 0, colour.plane.width(), colour.plane.height()}};
        const auto pixels = static_cast<size_t>(d.part.id.box.area());
        d.part.colour.resize(pixels);
        d.part.depth.resize(pixels);
        d.depth.resize(pixels);
        size_t covered = 0;
        for (size_t i = 0; i < pixels; ++i) {
            uint32_t word = 0;
            std::memcpy(&word, depth->plane.bytes().data() + 4 * i, 4);
            std::memcpy(&d.part.colour[i], colour.plane.bytes().data() + 4 * i, 4);
            const uint32_t d24 = word >> 8;
            if (d24 == 0xffffff) d.part.colour[i] = kRule.clearedColour; // unifies the backgrounds of the scenes
            covered += d24 != 0xffffff;
            d.part.depth[i] = d24 << 8 | d24 >> 16;
            d.depth[i] = static_cast<float>(static_cast<double>(d24) / 0xffffff);
        }
        if (covered > 0) all.push_back(std::move(d));
    }
    // With too few scenes, adds the same upside down.
    const size_t captured = all.size();
    for (size_t s = 0; captured > 1 && s < captured && all.size() < kMaxRanks; ++s) {
        Drawn turned = all[s];
        const auto turn = [&](auto& values) {
            const auto width = static_cast<ptrdiff_t>(turned.part.id.box.w);
            for (ptrdiff_t y = 0; y < turned.part.id.box.h / 2; ++y)
                std::swap_ranges(values.begin() + y * width, values.begin() + (y + 1) * width,
                                 values.end() - (y + 1) * width);
        };
        turn(turned.part.colour);
        turn(turned.part.depth);
        turn(turned.depth);
        all.push_back(std::move(turned));
    }
    return all;
}

// Messages of PictureComposer over the links of the benchmark.
class LinkRoutes final : public PartRoutes {
public:
    explicit LinkRoutes(RankLinks& links) : links_(links) {}
    Result<void> send(int rank, std::vector<std::byte> message, Deadline) override {
        sent_.push_back({rank, 0, std::move(message)});
        sent_.back().number = links_.post(rank, kPartTag, sent_.back().bytes);
        return {};
    }
    Result<std::vector<std::byte>> receive(int rank, size_t maxBytes, Deadline) override {
        RankMessage message = links_.take(rank, kPartTag);
        if (message.bytes.size() > maxBytes) return Error{"a message is too large"};
        return std::move(message.bytes);
    }
    LinkTransfer takeTransfer(int rank) override {
        const auto [bytes, ns] = links_.takeTransfer(rank);
        return {bytes, ns};
    }
    void giveUp(int) override {}
    void renew(int, uint32_t) override {} // no rank is lost
    // Called at the end of a picture.
    void waitSent() {
        for (const SentMessage& k : sent_) links_.waitSent(k.rank, k.number);
        sent_.clear();
    }

private:
    struct SentMessage {
        int rank;
        uint64_t number;
        std::vector<std::byte> bytes;
    };
    RankLinks& links_;
    std::deque<SentMessage> sent_;
};

int64_t processCpuNowNs() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec * kNsPerS + now.tv_nsec;
}

// Returns the number of pixels that differ from the depth test in draw order; pixels with equal depths count for Mural
// only.
int64_t wrongPixels(const std::vector<Drawn>& drawn, int ranks, const uint32_t* got, bool tiesCount) {
    int64_t wrong = 0;
    for (size_t i = 0; i < drawn[0].part.colour.size(); ++i) {
        uint32_t depth = kRule.clearedDepth, colour = kRule.clearedColour;
        bool tie = false;
        for (int r = 0; r < ranks; ++r) {
            const PicturePart& p = drawn[static_cast<size_t>(r)].part;
            if (p.depth[i] == depth && depth != kRule.clearedDepth) tie = true;
            if (p.depth[i] >= depth) continue;
            depth = p.depth[i];
            colour = p.colour[i];
            tie = false;
        }
        wrong += got[i] != colour && (tiesCount || !tie);
    }
    return wrong;
}

// Runs one rank: composites frames between barriers by `compose`, which returns the picture at the first rank.
template <class Compose>
RankResult measure(RankLinks& links, const std::vector<Drawn>& drawn, int frames, bool tiesCount, Compose&& compose) {
    RankResult result;
    const uint32_t* picture = nullptr;
    uint64_t before = 0;
    for (int f = 0; f < kWarmFrames + frames; ++f) {
        if (f == kWarmFrames) before = links.bytesSent();
        links.barrier();
        const int64_t tookNs = compose(picture);
        if (f >= kWarmFrames) result.cpuNs += tookNs;
    }
    result.cpuNs /= frames;
    result.bytes = (links.bytesSent() - before) / static_cast<uint64_t>(frames);
    if (links.own() == 0) result.wrong = picture == nullptr ? 1 : wrongPixels(drawn, links.ranks(), picture, tiesCount);
    return result;
}

RankResult composeByMural(RankLinks& links, const std::vector<Drawn>& drawn, const ChosenFilter& filter, int frames) {
    LinkRoutes routes(links);
    PictureComposer composer({filter.strategy, links.own(), links.ranks(), 60'000, 60'000, 5'000, ""}, routes);
    PicturePart part;
    return measure(links, drawn, frames, true, [&](const uint32_t*& picture) {
        const uint64_t serial = part.id.serial;
        part = drawn[static_cast<size_t>(links.own())].part; // as read from the GL
        part.id.serial = serial + 1;
        const int64_t beganNs = processCpuNowNs();
        composer.compose(part, kRule);
        routes.waitSent();
        picture = part.colour.data();
        return processCpuNowNs() - beganNs;
    });
}

RankLinks& linksOf(void* self) { return *static_cast<RankLinks*>(self); }

RankResult composeByIcet(RankLinks& links, const std::vector<Drawn>& drawn, const ChosenFilter& filter, int frames,
                         const std::string& path) {
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    const auto open = library ? reinterpret_cast<icet_ranks_open_function>(dlsym(library, "icet_ranks_open")) : nullptr;
    const auto composed =
        library ? reinterpret_cast<icet_ranks_compose_function>(dlsym(library, "icet_ranks_compose")) : nullptr;
    const icet_links given{&links,
                           links.own(),
                           links.ranks(),
                           [](void* self, int to, uint64_t tag, const void* from, size_t bytes) {
                               return linksOf(self).post(to, tag, {static_cast<const std::byte*>(from), bytes});
                           },
                           [](void* self, int to, uint64_t number) { linksOf(self).waitSent(to, number); },
                           [](void* self, int from, uint64_t tag, void* into, size_t bytes) {
                               return linksOf(self).takeInto(from, tag, {static_cast<std::byte*>(into), bytes});
                           },
                           [](void* self, int from, uint64_t tag) { return linksOf(self).waiting(from, tag) ? 1 : 0; },
                           [](void* self, const int* from, int count) {
                               linksOf(self).waitForAny({from, from + count});
                           }};
    const PixelViewport& box = drawn[0].part.id.box;
    if (!open || !composed || !open(&given, box.w, box.h, static_cast<icet_way>(filter.icetStrategy))) {
        fmt::print(stderr, "compositing_bench: IceT: {} cannot be used; let tools/bench/compositing --icet build it\n",
                   path);
        std::_Exit(1);
    }
    const Drawn& own = drawn[static_cast<size_t>(links.own())];
    return measure(links, drawn, frames, false, [&](const uint32_t*& picture) {
        const int64_t beganNs = processCpuNowNs();
        picture = static_cast<const uint32_t*>(composed(own.part.colour.data(), own.depth.data()));
        return processCpuNowNs() - beganNs;
    });
}

struct Sum {
    int64_t meanCpuNs = 0, maxCpuNs = 0;
    uint64_t bytes = 0;
    std::string fault;
};

// Runs all ranks as processes; closes their sockets.
template <class Rank> Sum perform(int ranks, Rank&& rank) {
    Sum sum;
    auto sockets = RankSockets::make(ranks);
    if (!sockets) return {0, 0, 0, sockets.error().message};
    int results[2];
    if (pipe(results) != 0) return {0, 0, 0, "no pipe for results"};
    std::vector<pid_t> children;
    std::fflush(nullptr);
    for (int r = 0; r < ranks; ++r) {
        const pid_t child = fork();
        if (child == 0) {
            sockets->closeOthers(r);
            RankResult result;
            {
                RankLinks links(*sockets, r);
                result = rank(links);
                links.barrier();
            }
            std::_Exit(write(results[1], &result, sizeof result) == static_cast<ssize_t>(sizeof result) ? 0 : 1);
        }
        if (child > 0)
            children.push_back(child);
        else
            sum.fault = "no more processes could be started";
    }
    sockets->closeAll();
    close(results[1]);
    RankResult result;
    int count = 0;
    // all ends close when all ranks have ended; a rank waits at most a minute for another
    while (read(results[0], &result, sizeof result) == static_cast<ssize_t>(sizeof result)) {
        ++count;
        sum.meanCpuNs += result.cpuNs / ranks;
        sum.maxCpuNs = std::max(sum.maxCpuNs, result.cpuNs);
        sum.bytes += result.bytes;
        if (result.wrong > 0) sum.fault = fmt::format("{} pixels are wrong", result.wrong);
    }
    close(results[0]);
    for (const pid_t child : children) waitpid(child, nullptr, 0);
    if (count != ranks && sum.fault.empty()) sum.fault = fmt::format("{} of {} ranks came to their end", count, ranks);
    return sum;
}

std::string cell(const Sum& s) {
    return s.fault.empty() ? fmt::format("{:.2f} / {:.2f} / {:.2f}", static_cast<double>(s.meanCpuNs) / 1e6,
                                         static_cast<double>(s.maxCpuNs) / 1e6, static_cast<double>(s.bytes) / 1e6)
                           : "failed";
}

} // namespace

Faults benchRanks(const std::vector<NamedPlane>& planes, const BenchOptions& options) {
    Faults faults;
    const std::vector<Drawn> drawn = drawnOf(planes);
    if (drawn.size() < 2)
        return {"there are not two scenes with colour and D24S8 depth of one size to put together; capture more"};
    fmt::print("\n{} x {} pixels by depth, each rank another scene, processes joined by sockets: CPU ms of a rank in "
               "the mean / of the busiest / MB that all send, a frame\n",
               drawn[0].part.id.box.w, drawn[0].part.id.box.h);
    fmt::print("{:<14} {:>5} {:>24} {:>24} {:>22} {:>8}\n", "", "ranks", "ours", "IceT", "IceT's CPU over ours",
               "bytes");
    for (const ChosenFilter& filter : kWays)
        for (const int ranks : {2, 3, 4, 8, static_cast<int>(kMaxRanks)}) {
            if (static_cast<size_t>(ranks) > drawn.size() || (options.quick && ranks > 3)) continue;
            Sum best[2]; // the fastest of several turns
            const int turns = options.quick ? 1 : 3, frames = options.quick ? 3 : 10;
            for (int turn = 0; turn < turns; ++turn)
                for (const bool byIcet : {false, true}) {
                    if (byIcet && (options.icetLibrary.empty() || filter.icetStrategy < 0)) continue;
                    const Sum sum = perform(ranks, [&](RankLinks& links) {
                        return byIcet ? composeByIcet(links, drawn, filter, frames, options.icetLibrary)
                                      : composeByMural(links, drawn, filter, frames);
                    });
                    if (!sum.fault.empty())
                        faults.push_back(fmt::format("{} by {} ranks, {}: {}", filter.name, ranks,
                                                     byIcet ? "IceT" : "ours", sum.fault));
                    if (turn == 0 || sum.meanCpuNs < best[byIcet].meanCpuNs || !sum.fault.empty()) best[byIcet] = sum;
                }
            const bool both = best[1].meanCpuNs > 0 && best[0].meanCpuNs > 0;
            fmt::print("{:<14} {:>5} {:>24} {:>24} {:>22} {:>8}\n", filter.name, ranks, cell(best[0]),
                       best[1].meanCpuNs > 0 ? cell(best[1]) : "",
                       both ? fmt::format("{:.2f}", static_cast<double>(best[1].meanCpuNs) /
                                                        static_cast<double>(best[0].meanCpuNs))
                            : "",
                       both && best[0].bytes > 0 ? fmt::format("{:.2f}", static_cast<double>(best[1].bytes) /
                                                                             static_cast<double>(best[0].bytes))
                                                 : "");
            std::fflush(stdout);
        }
    return faults;
}

} // namespace mural::bench
