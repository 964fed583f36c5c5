#include "transport/plugin/plugin_connection.hpp"

namespace mural {

namespace {

using Plugin = mural_transport_plugin;

Error errorFrom(mural_transport_error& error) {
    error.text[sizeof error.text - 1] = 0;
    return Error{error.text[0] ? error.text : "the transport plug-in failed without a message"};
}

class PluginConnection final : public Connection {
public:
    PluginConnection(const Plugin& plugin, mural_transport_connection* connection)
        : plugin_(plugin), connection_(connection) {}
    ~PluginConnection() override { plugin_.free_connection(connection_); }

    Result<void> read(std::span<std::byte> into, Deadline deadline) override {
        mural_transport_error error{};
        if (plugin_.read(connection_, into.data(), into.size(), deadline.atNs(), &error)) return {};
        return errorFrom(error);
    }
    Result<void> write(std::span<const std::byte> bytes, Deadline deadline) override {
        mural_transport_error error{};
        if (plugin_.write(connection_, bytes.data(), bytes.size(), deadline.atNs(), &error)) return {};
        return errorFrom(error);
    }
    void flush() override { plugin_.flush(connection_); }
    void close() override { plugin_.close(connection_); }
    [[nodiscard]] bool timedOut() const override { return plugin_.timed_out(connection_) != 0; }
    [[nodiscard]] bool alive() const override { return plugin_.alive(connection_) != 0; }
    [[nodiscard]] std::string describe() const override { return plugin_.connection_description(connection_); }
    [[nodiscard]] uint64_t bytesWritten() const override { return plugin_.bytes_written(connection_); }
    [[nodiscard]] uint64_t bytesRead() const override { return plugin_.bytes_read(connection_); }

private:
    const Plugin& plugin_;
    mural_transport_connection* connection_;
};

class PluginListener final : public Listener {
public:
    PluginListener(const Plugin& plugin, mural_transport_listener* listener) : plugin_(plugin), listener_(listener) {}
    ~PluginListener() override { plugin_.free_listener(listener_); }

    Result<std::unique_ptr<Connection>> accept(Deadline deadline) override {
        mural_transport_error error{};
        mural_transport_connection* made = nullptr;
        if (!plugin_.accept(listener_, deadline.atNs(), &made, &error)) return errorFrom(error);
        return std::unique_ptr<Connection>(std::make_unique<PluginConnection>(plugin_, made));
    }
    [[nodiscard]] std::string describe() const override { return plugin_.listener_description(listener_); }

private:
    const Plugin& plugin_;
    mural_transport_listener* listener_;
};

} // namespace

Result<std::unique_ptr<Connection>> connectByPlugin(const Plugin& plugin, const std::string& description,
                                                    Deadline deadline) {
    mural_transport_error error{};
    mural_transport_connection* made = nullptr;
    if (!plugin.connect(description.c_str(), deadline.atNs(), &made, &error)) return errorFrom(error);
    return std::unique_ptr<Connection>(std::make_unique<PluginConnection>(plugin, made));
}

Result<std::unique_ptr<Listener>> listenByPlugin(const Plugin& plugin, const std::string& description) {
    mural_transport_error error{};
    mural_transport_listener* made = nullptr;
    if (!plugin.listen(description.c_str(), &made, &error)) return errorFrom(error);
    return std::unique_ptr<Listener>(std::make_unique<PluginListener>(plugin, made));
}

} // namespace mural
