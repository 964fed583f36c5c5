// TCP through a plug-in: wrapped://host:port.
#include "transport/plugin/exported_transport.hpp"

namespace mural::test {

namespace {

class WrappedListener final : public Listener {
public:
    explicit WrappedListener(std::unique_ptr<Listener> inner) : inner_(std::move(inner)) {}
    Result<std::unique_ptr<Connection>> accept(Deadline deadline) override { return inner_->accept(deadline); }
    [[nodiscard]] std::string describe() const override { return "wrapped" + inner_->describe().substr(3); }

private:
    std::unique_ptr<Listener> inner_;
};

Result<std::unique_ptr<Connection>> connectWrapped(const ConnectionDescription& to, Deadline deadline) {
    return connectTcp(to.host, to.port, deadline);
}

Result<std::unique_ptr<Listener>> listenWrapped(const ConnectionDescription& at) {
    auto inner = listenTcp(at.host, at.port);
    if (!inner) return inner.error();
    return std::unique_ptr<Listener>(std::make_unique<WrappedListener>(std::move(*inner)));
}

} // namespace

} // namespace mural::test

extern "C" const mural_transport_plugin* mural_get_transport_plugin() {
    static const auto table =
        mural::exportedTransport<mural::test::connectWrapped, mural::test::listenWrapped>("wrapped");
    return &table;
}
