// The equalizers of the current LoadBalancer as operations of the control interface.
#pragma once

#include <functional>
#include <memory>

#include "nodes/head/balancing/load_balancer.hpp"
#include "nodes/head/control/equalizer_control.hpp"

namespace mural {

class BalancerControl : public EqualizerControl {
public:
    explicit BalancerControl(std::function<std::shared_ptr<LoadBalancer>()> current) : current_(std::move(current)) {}

    [[nodiscard]] nlohmann::json list() const override;
    Result<void> set(const std::string& name, const std::string& parameter, const std::string& value) override {
        return current_()->set(name, parameter, value);
    }
    Result<void> freeze(const std::string& name, bool isFrozen) override { return current_()->freeze(name, isFrozen); }

private:
    const std::function<std::shared_ptr<LoadBalancer>()> current_;
};

} // namespace mural
