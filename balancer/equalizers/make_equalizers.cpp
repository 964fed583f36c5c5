#include "balancer/equalizers/make_equalizers.hpp"

#include "balancer/equalizers/cost_map/cost_map_equalizer.hpp"
#include "balancer/equalizers/dfr_equalizer.hpp"
#include "balancer/equalizers/framerate_equalizer.hpp"
#include "balancer/equalizers/load_equalizer.hpp"
#include "balancer/equalizers/monitor_equalizer.hpp"
#include "balancer/equalizers/tile_equalizer.hpp"
#include "balancer/equalizers/tree_equalizer.hpp"
#include "balancer/equalizers/view_equalizer.hpp"

namespace mural::balance {

namespace {

class Maker {
public:
    Maker(const ResolvedConfig& config, Balance balance) : config_(config), balance_(balance) {}

    std::vector<std::unique_ptr<Equalizer>> make() {
        for (const Index root : config_.roots) visit(root);
        return std::move(made_);
    }

private:
    void visit(Index compound) {
        const config::ResolvedCompound& c = config_.compounds[at(compound)];
        for (const config::Equalizer& e : c.equalizers)
            std::visit([&](const auto& fields) { add(compound, fields); }, e);
        for (const config::ResolvedQueue& q : c.outputQueues) // tile_equalizer{} has become a queue
            made_.push_back(std::make_unique<TileEqualizer>(idOf(compound, "queue"), config_, compound, q));
        for (const Index child : c.children) visit(child);
    }

    // Returns a unique name: that of the compound, or its number, and the kind.
    [[nodiscard]] std::string idOf(Index compound, const std::string& kind) const {
        const std::string& name = config_.compounds[at(compound)].name;
        const std::string id = (name.empty() ? std::to_string(compound) : name) + "." + kind;
        std::string unique = id;
        for (int i = 2; std::any_of(made_.begin(), made_.end(), [&](const auto& e) { return e->id() == unique; }); ++i)
            unique = id + "." + std::to_string(i);
        return unique;
    }

    void add(Index compound, const config::LoadEqualizer& fields) { addSplit(compound, fields, Balance::Load); }
    void add(Index compound, const config::TreeEqualizer& fields) { addSplit(compound, fields, Balance::Tree); }
    void add(Index compound, const config::DfrEqualizer& fields) {
        made_.push_back(std::make_unique<DfrEqualizer>(idOf(compound, "DFR"), config_, compound, fields));
    }
    void add(Index compound, const config::FramerateEqualizer&) {
        made_.push_back(std::make_unique<FramerateEqualizer>(idOf(compound, "framerate"), config_, compound));
    }
    void add(Index compound, const config::MonitorEqualizer&) {
        made_.push_back(std::make_unique<MonitorEqualizer>(idOf(compound, "monitor"), config_, compound));
    }
    void add(Index compound, const config::ViewEqualizer&) {
        made_.push_back(std::make_unique<ViewEqualizer>(idOf(compound, "view"), config_, compound));
    }
    void add(Index, const config::TileEqualizer&) {} // the queue of the compound

    template <class Fields> void addSplit(Index compound, const Fields& fields, Balance kind) {
        switch (balance_ == Balance::AsInFile ? kind : balance_) {
        case Balance::Auto:
            made_.push_back(std::make_unique<CostMapEqualizer>(idOf(compound, "cost_map"), config_, compound,
                                                               fields.mode.value_or(config::SplitMode::TwoD)));
            break;
        case Balance::Load:
            made_.push_back(std::make_unique<LoadEqualizer>(idOf(compound, "load"), config_, compound,
                                                            as<config::LoadEqualizer>(fields)));
            break;
        case Balance::Tree:
            made_.push_back(std::make_unique<TreeEqualizer>(idOf(compound, "tree"), config_, compound,
                                                            as<config::TreeEqualizer>(fields)));
            break;
        case Balance::AsInFile:
        case Balance::Off: break;
        }
    }

    // Load and tree equalizers have the same fields, except for the limit of the former.
    template <class To, class From> static To as(const From& from) {
        To to;
        to.mode = from.mode;
        to.damping = from.damping;
        to.boundary = from.boundary;
        to.resistance = from.resistance;
        if constexpr (std::is_same_v<To, config::LoadEqualizer> && std::is_same_v<From, config::LoadEqualizer>)
            to.assembleOnlyLimit = from.assembleOnlyLimit;
        return to;
    }

    const ResolvedConfig& config_;
    const Balance balance_;
    std::vector<std::unique_ptr<Equalizer>> made_;
};

} // namespace

std::vector<std::unique_ptr<Equalizer>> makeEqualizers(const ResolvedConfig& config, Balance balance) {
    return Maker(config, balance).make();
}

} // namespace mural::balance
