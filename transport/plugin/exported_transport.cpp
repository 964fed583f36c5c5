#include "transport/plugin/exported_transport.hpp"

#include <cstdio>

// Wrappers that keep the descriptions alive, because C callers receive pointers to them.
struct mural_transport_connection {
    std::unique_ptr<mural::Connection> connection;
    std::string description;
};
struct mural_transport_listener {
    std::unique_ptr<mural::Listener> listener;
    std::string description;
};

namespace mural::exported {

namespace {

int failed(mural_transport_error* error, const Error& why) {
    std::snprintf(error->text, sizeof error->text, "%s", why.message.c_str());
    return 0;
}

int done(const Result<void>& result, mural_transport_error* error) {
    return result ? 1 : failed(error, result.error());
}

int give(Result<std::unique_ptr<Connection>> made, mural_transport_connection** into, mural_transport_error* error) {
    if (!made) return failed(error, made.error());
    std::string description = (*made)->describe();
    *into = new mural_transport_connection{std::move(*made), std::move(description)};
    return 1;
}

} // namespace

int connect(ConnectFunction function, const char* text, int64_t deadlineNs, mural_transport_connection** into,
            mural_transport_error* error) {
    auto description = parseConnectionDescription(text);
    if (!description) return failed(error, description.error());
    return give(function(*description, Deadline::at(deadlineNs)), into, error);
}

int listen(ListenFunction function, const char* text, mural_transport_listener** into, mural_transport_error* error) {
    auto parsed = parseConnectionDescription(text);
    if (!parsed) return failed(error, parsed.error());
    auto made = function(*parsed);
    if (!made) return failed(error, made.error());
    std::string description = (*made)->describe();
    *into = new mural_transport_listener{std::move(*made), std::move(description)};
    return 1;
}

mural_transport_plugin table(const char* scheme) {
    using C = mural_transport_connection;
    using L = mural_transport_listener;
    mural_transport_plugin plugin{};
    plugin.version = MURAL_TRANSPORT_PLUGIN_VERSION;
    plugin.size_bytes = sizeof plugin;
    plugin.scheme = scheme;
    plugin.accept = [](L* l, int64_t deadlineNs, C** into, mural_transport_error* error) {
        return give(l->listener->accept(Deadline::at(deadlineNs)), into, error);
    };
    plugin.listener_description = [](const L* l) { return l->description.c_str(); };
    plugin.free_listener = [](L* l) { delete l; };
    plugin.read = [](C* c, void* into, size_t sizeBytes, int64_t deadlineNs, mural_transport_error* error) {
        return done(c->connection->read({static_cast<std::byte*>(into), sizeBytes}, Deadline::at(deadlineNs)), error);
    };
    plugin.write = [](C* c, const void* bytes, size_t sizeBytes, int64_t deadlineNs, mural_transport_error* error) {
        return done(c->connection->write({static_cast<const std::byte*>(bytes), sizeBytes}, Deadline::at(deadlineNs)),
                    error);
    };
    plugin.flush = [](C* c) { c->connection->flush(); };
    plugin.close = [](C* c) { c->connection->close(); };
    plugin.timed_out = [](const C* c) { return c->connection->timedOut() ? 1 : 0; };
    plugin.alive = [](const C* c) { return c->connection->alive() ? 1 : 0; };
    plugin.connection_description = [](const C* c) { return c->description.c_str(); };
    plugin.bytes_written = [](const C* c) { return c->connection->bytesWritten(); };
    plugin.bytes_read = [](const C* c) { return c->connection->bytesRead(); };
    plugin.free_connection = [](C* c) { delete c; };
    return plugin;
}

} // namespace mural::exported
