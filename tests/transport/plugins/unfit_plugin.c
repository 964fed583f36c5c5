/* Invalid transport plug-ins: each build has another fault, by a macro of CMakeLists.txt. */
#include "transport/plugin/transport_plugin.h"

#ifndef UNFIT_VERSION
#define UNFIT_VERSION MURAL_TRANSPORT_PLUGIN_VERSION
#endif
#ifndef UNFIT_SIZE_BYTES
#define UNFIT_SIZE_BYTES sizeof(struct mural_transport_plugin)
#endif
#ifndef UNFIT_ENTRY
#define UNFIT_ENTRY mural_get_transport_plugin
#endif

const struct mural_transport_plugin* UNFIT_ENTRY(void);

const struct mural_transport_plugin* UNFIT_ENTRY(void) {
    static const struct mural_transport_plugin table = {
        .version = UNFIT_VERSION, .size_bytes = UNFIT_SIZE_BYTES, .scheme = UNFIT_SCHEME};
    return &table;
}
