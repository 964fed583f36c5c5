// Implements transport_plugin.h for plug-ins in C++: builds the table from two functions that connect and listen.
//
//   extern "C" __attribute__((visibility("default"))) const mural_transport_plugin* mural_get_transport_plugin() {
//       static const auto table = mural::exportedTransport<connectHere, listenHere>("scheme");
//       return &table;
//   }
#pragma once

#include "transport/connection.hpp"
#include "transport/connection_description.hpp"
#include "transport/plugin/transport_plugin.h"

namespace mural {

using ConnectFunction = Result<std::unique_ptr<Connection>> (*)(const ConnectionDescription&, Deadline);
using ListenFunction = Result<std::unique_ptr<Listener>> (*)(const ConnectionDescription&);

namespace exported {
int connect(ConnectFunction function, const char* text, int64_t deadlineNs, mural_transport_connection** into,
            mural_transport_error* error);
int listen(ListenFunction function, const char* text, mural_transport_listener** into, mural_transport_error* error);
// Returns the table without connect and listen.
mural_transport_plugin table(const char* scheme);
} // namespace exported

template <ConnectFunction connectFunction, ListenFunction listenFunction>
mural_transport_plugin exportedTransport(const char* scheme) {
    mural_transport_plugin plugin = exported::table(scheme);
    plugin.connect = [](const char* text, int64_t deadlineNs, mural_transport_connection** into,
                        mural_transport_error* error) {
        return exported::connect(connectFunction, text, deadlineNs, into, error);
    };
    plugin.listen = [](const char* text, mural_transport_listener** into, mural_transport_error* error) {
        return exported::listen(listenFunction, text, into, error);
    };
    return plugin;
}

} // namespace mural
