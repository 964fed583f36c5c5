#include "transport/discovery/avahi_publisher.hpp"

#include "transport/discovery/avahi_library.hpp"

namespace mural {

// State of the Avahi thread; no other thread uses it.
struct AvahiPublisher::Service {
    Announcement self;
    std::string name; // another name after a collision
    const AvahiLibrary* avahi = nullptr;
    std::shared_ptr<AvahiThread::Shared> shared;
    AvahiEntryGroup* group = nullptr; // owned by the Avahi client

    void add();
    static void changed(AvahiEntryGroup*, AvahiEntryGroupState state, void* data);
};

void AvahiPublisher::Service::add() {
    AvahiStringList* facts = nullptr;
    facts = avahi->stringListAddPair(facts, "uuid", uuidText(self.uuid).c_str());
    facts = avahi->stringListAddPair(facts, "version", self.version.c_str());
    facts = avahi->stringListAddPair(facts, "name", self.name.c_str());
    int code =
        avahi->entryGroupAddService(group, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, static_cast<AvahiPublishFlags>(0),
                                    name.c_str(), kAvahiServiceType, nullptr, nullptr, self.port, facts);
    avahi->stringListFree(facts);
    if (code == 0) code = avahi->entryGroupCommit(group);
    if (code == AVAHI_ERR_COLLISION) return changed(group, AVAHI_ENTRY_GROUP_COLLISION, this);
    if (code != 0) shared->setTrouble(std::string("Avahi: ") + avahi->strerror(code));
}

void AvahiPublisher::Service::changed(AvahiEntryGroup* g, AvahiEntryGroupState state, void* data) {
    auto& s = *static_cast<Service*>(data);
    s.group = g; // the first callback precedes the return of entryGroupNew()
    if (state == AVAHI_ENTRY_GROUP_COLLISION) {
        char* other = s.avahi->alternativeServiceName(s.name.c_str());
        if (!other) return;
        s.name = other;
        s.avahi->free(other);
        s.avahi->entryGroupReset(g);
        s.add();
    } else if (state == AVAHI_ENTRY_GROUP_FAILURE) {
        s.shared->setTrouble("Avahi: cannot announce the service");
    }
}

AvahiPublisher::AvahiPublisher(const Announcement& self)
    : AvahiPublisher(std::make_shared<Service>(Service{self, self.name, nullptr, nullptr, nullptr})) {}

AvahiPublisher::AvahiPublisher(const std::shared_ptr<Service>& service)
    : thread_(
          [service](const AvahiLibrary& avahi, AvahiClient* client,
                    const std::shared_ptr<AvahiThread::Shared>& shared) {
              service->avahi = &avahi;
              service->shared = shared;
              if (!service->group) service->group = avahi.entryGroupNew(client, Service::changed, service.get());
              if (!service->group)
                  return shared->setTrouble(std::string("Avahi: ") + avahi.strerror(avahi.clientErrno(client)));
              avahi.entryGroupReset(service->group);
              service->add();
          },
          [service] { service->group = nullptr; }) {}

} // namespace mural
