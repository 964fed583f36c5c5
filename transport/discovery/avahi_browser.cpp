#include "transport/discovery/avahi_browser.hpp"

#include <algorithm>
#include <map>
#include <net/if.h>

#include "transport/discovery/avahi_library.hpp"

namespace mural {

// Only the thread's.
struct AvahiBrowser::Search {
    Found found;
    Lost lost;
    const AvahiLibrary* avahi = nullptr;
    AvahiServiceBrowser* browser = nullptr; // the client's
    std::map<std::string, Uuid> known;      // by the service's name

    [[nodiscard]] std::string fact(AvahiStringList* facts, const char* name) const {
        AvahiStringList* pair = avahi->stringListFind(facts, name);
        char* value = nullptr;
        if (!pair || avahi->stringListGetPair(pair, nullptr, &value, nullptr) != 0 || !value) return {};
        const std::string text = value;
        avahi->free(value);
        return text;
    }
    static void browsed(AvahiServiceBrowser* browser, AvahiIfIndex interface, AvahiProtocol protocol,
                        AvahiBrowserEvent event, const char* name, const char* type, const char* domain,
                        AvahiLookupResultFlags flags, void* data);
    static void resolved(AvahiServiceResolver* resolver, AvahiIfIndex interface, AvahiProtocol protocol,
                         AvahiResolverEvent event, const char* name, const char* type, const char* domain,
                         const char* host, const AvahiAddress* address, uint16_t port, AvahiStringList* facts,
                         AvahiLookupResultFlags flags, void* data);

    AvahiClient* client = nullptr;
};

void AvahiBrowser::Search::browsed(AvahiServiceBrowser*, AvahiIfIndex interface, AvahiProtocol protocol,
                                   AvahiBrowserEvent event, const char* name, const char* type, const char* domain,
                                   AvahiLookupResultFlags, void* data) {
    auto& s = *static_cast<Search*>(data);
    if (event == AVAHI_BROWSER_NEW) {
        // resolved() frees the resolver.
        (void)s.avahi->serviceResolverNew(s.client, interface, protocol, name, type, domain, AVAHI_PROTO_UNSPEC,
                                          static_cast<AvahiLookupFlags>(0), resolved, data);
    } else if (event == AVAHI_BROWSER_REMOVE) {
        if (const auto at = s.known.find(name); at != s.known.end()) {
            s.lost(at->second);
            s.known.erase(at);
        }
    }
}

void AvahiBrowser::Search::resolved(AvahiServiceResolver* resolver, AvahiIfIndex interface, AvahiProtocol,
                                    AvahiResolverEvent event, const char* name, const char*, const char*, const char*,
                                    const AvahiAddress* address, uint16_t port, AvahiStringList* facts,
                                    AvahiLookupResultFlags, void* data) {
    auto& s = *static_cast<Search*>(data);
    const auto uuid = event == AVAHI_RESOLVER_FOUND ? uuidFromText(s.fact(facts, "uuid")) : std::nullopt;
    if (uuid && address && port != 0) {
        char text[AVAHI_ADDRESS_STR_MAX] = {};
        s.avahi->addressSnprint(text, sizeof text, address);
        std::string where = text;
        char card[IF_NAMESIZE] = {};
        if (where.starts_with("fe80:") && interface >= 0 && if_indextoname(static_cast<unsigned>(interface), card))
            where += std::string("%") + card;
        // Validates as strictly as the beacon, because the texts are shown on terminals.
        const Announcement announced{AnnouncementKind::Here, port, *uuid, s.fact(facts, "name"),
                                     s.fact(facts, "version")};
        if (const auto a = decodeAnnouncement(encode(announced))) {
            s.known[name] = *uuid;
            s.found(*a, where);
        }
    }
    s.avahi->serviceResolverFree(resolver);
}

AvahiBrowser::AvahiBrowser(Found found, Lost lost)
    : AvahiBrowser(std::make_shared<Search>(Search{std::move(found), std::move(lost), nullptr, nullptr, {}, nullptr})) {
}

AvahiBrowser::AvahiBrowser(const std::shared_ptr<Search>& search)
    : thread_(
          [search](const AvahiLibrary& avahi, AvahiClient* client, const std::shared_ptr<AvahiThread::Shared>& shared) {
              search->avahi = &avahi;
              search->client = client;
              if (search->browser) return;
              search->browser =
                  avahi.serviceBrowserNew(client, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, kAvahiServiceType, nullptr,
                                          static_cast<AvahiLookupFlags>(0), Search::browsed, search.get());
              if (!search->browser)
                  shared->setTrouble(std::string("Avahi: ") + avahi.strerror(avahi.clientErrno(client)));
          },
          [search] { search->browser = nullptr; }) {}

} // namespace mural
