#include "transport/discovery/avahi_library.hpp"

#include <dlfcn.h>

namespace mural {

namespace {

struct Opened {
    AvahiLibrary avahi{};
    std::string why; // empty: it is there
};

template <class F> void find(void* handle, const char* name, F& into, std::string& why) {
    into = reinterpret_cast<F>(dlsym(handle, name));
    if (!into && why.empty()) why = std::string("libavahi-client has no ") + name;
}

Opened openAvahi() {
    Opened o;
    // It brings libavahi-common along. Never closed: threads may be in it.
    void* handle = dlopen("libavahi-client.so.3", RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        o.why = "libavahi-client is not installed (Debian's libavahi-client3)";
        return o;
    }
    AvahiLibrary& l = o.avahi;
    find(handle, "avahi_simple_poll_new", l.simplePollNew, o.why);
    find(handle, "avahi_simple_poll_free", l.simplePollFree, o.why);
    find(handle, "avahi_simple_poll_get", l.simplePollGet, o.why);
    find(handle, "avahi_simple_poll_iterate", l.simplePollIterate, o.why);
    find(handle, "avahi_client_new", l.clientNew, o.why);
    find(handle, "avahi_client_free", l.clientFree, o.why);
    find(handle, "avahi_client_errno", l.clientErrno, o.why);
    find(handle, "avahi_strerror", l.strerror, o.why);
    find(handle, "avahi_free", l.free, o.why);
    find(handle, "avahi_alternative_service_name", l.alternativeServiceName, o.why);
    find(handle, "avahi_entry_group_new", l.entryGroupNew, o.why);
    find(handle, "avahi_entry_group_reset", l.entryGroupReset, o.why);
    find(handle, "avahi_entry_group_commit", l.entryGroupCommit, o.why);
    find(handle, "avahi_entry_group_add_service_strlst", l.entryGroupAddService, o.why);
    find(handle, "avahi_service_browser_new", l.serviceBrowserNew, o.why);
    find(handle, "avahi_service_resolver_new", l.serviceResolverNew, o.why);
    find(handle, "avahi_service_resolver_free", l.serviceResolverFree, o.why);
    find(handle, "avahi_string_list_add_pair", l.stringListAddPair, o.why);
    find(handle, "avahi_string_list_free", l.stringListFree, o.why);
    find(handle, "avahi_string_list_find", l.stringListFind, o.why);
    find(handle, "avahi_string_list_get_pair", l.stringListGetPair, o.why);
    find(handle, "avahi_address_snprint", l.addressSnprint, o.why);
    return o;
}

} // namespace

const AvahiLibrary* AvahiLibrary::get(std::string& why) {
    static const Opened opened = openAvahi();
    why = opened.why;
    return why.empty() ? &opened.avahi : nullptr;
}

} // namespace mural
