// The equalizers of a LoadBalancer as operations of the control interface.
#pragma once

#include "nodes/head/balancing/load_balancer.hpp"
#include "nodes/head/control/equalizer_control.hpp"

namespace mural {

class BalancerControl : public EqualizerControl {
public:
    // Keeps a reference.
    explicit BalancerControl(LoadBalancer& balancer) : balancer_(balancer) {}

    [[nodiscard]] nlohmann::json list() const override;
    Result<void> set(const std::string& name, const std::string& parameter, const std::string& value) override {
        return balancer_.set(name, parameter, value);
    }
    Result<void> freeze(const std::string& name, bool isFrozen) override { return balancer_.freeze(name, isFrozen); }

private:
    LoadBalancer& balancer_;
};

} // namespace mural
