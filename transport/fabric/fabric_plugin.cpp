// Entry point of libmural_transport_fabric.so.
#include "transport/fabric/fabric_connect.hpp"
#include "transport/plugin/exported_transport.hpp"

extern "C" __attribute__((visibility("default"))) const mural_transport_plugin* mural_get_transport_plugin() {
    static const auto table =
        mural::exportedTransport<mural::fabric::connectFabric, mural::fabric::listenFabric>("fabric");
    return &table;
}
