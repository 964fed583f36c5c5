// Loads libavahi-client at run time where it is installed, so that Mural does not depend on it.
#pragma once

#include <string>

#include <avahi-client/client.h>
#include <avahi-client/lookup.h>
#include <avahi-client/publish.h>
#include <avahi-common/alternative.h>
#include <avahi-common/error.h>
#include <avahi-common/malloc.h>
#include <avahi-common/simple-watch.h>
#include <avahi-common/strlst.h>

namespace mural {

constexpr const char* kAvahiServiceType = "_mural-node._tcp";

// The functions of libavahi-client, without the prefix avahi_.
struct AvahiLibrary {
    // Returns the loaded library, shared by all callers. On failure returns nullptr and sets `why`.
    static const AvahiLibrary* get(std::string& why);

    decltype(&avahi_simple_poll_new) simplePollNew;
    decltype(&avahi_simple_poll_free) simplePollFree;
    decltype(&avahi_simple_poll_get) simplePollGet;
    decltype(&avahi_simple_poll_iterate) simplePollIterate;
    decltype(&avahi_client_new) clientNew;
    decltype(&avahi_client_free) clientFree;
    decltype(&avahi_client_errno) clientErrno;
    decltype(&avahi_strerror) strerror;
    decltype(&avahi_free) free;
    decltype(&avahi_alternative_service_name) alternativeServiceName;
    decltype(&avahi_entry_group_new) entryGroupNew;
    decltype(&avahi_entry_group_reset) entryGroupReset;
    decltype(&avahi_entry_group_commit) entryGroupCommit;
    decltype(&avahi_entry_group_add_service_strlst) entryGroupAddService;
    decltype(&avahi_service_browser_new) serviceBrowserNew;
    decltype(&avahi_service_resolver_new) serviceResolverNew;
    decltype(&avahi_service_resolver_free) serviceResolverFree;
    decltype(&avahi_string_list_add_pair) stringListAddPair;
    decltype(&avahi_string_list_free) stringListFree;
    decltype(&avahi_string_list_find) stringListFind;
    decltype(&avahi_string_list_get_pair) stringListGetPair;
    decltype(&avahi_address_snprint) addressSnprint;
};

} // namespace mural
