#include "two_packages.hpp"

#include <array>
#include <cstdio>

namespace mural {
namespace {

unsigned nextIndex = 1;

std::string mask(unsigned bits) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "0x%08x", bits);
    return text.data();
}

std::string sets(unsigned cpus, unsigned nodes) {
    return " cpuset=\"" + mask(cpus) + "\" complete_cpuset=\"" + mask(cpus) + "\" nodeset=\"" + mask(nodes) +
           "\" complete_nodeset=\"" + mask(nodes) + "\" gp_index=\"" + std::to_string(nextIndex++) + "\"";
}

std::string pciDevice(const std::string& bus, const std::string& type, const std::string& inside) {
    return "<object type=\"PCIDev\" gp_index=\"" + std::to_string(nextIndex++) + "\" pci_busid=\"0000:" + bus +
           ":00.0\" pci_type=\"" + type + " [0000:0000] 00\" pci_link_speed=\"0.000000\">" + inside + "</object>";
}

std::string networkCard(const std::string& bus, const std::string& name) {
    return pciDevice(bus, "0200 [8086:1521]",
                     "<object type=\"OSDev\" gp_index=\"" + std::to_string(nextIndex++) + "\" name=\"" + name +
                         "\" osdev_type=\"2\"/>");
}

std::string package(unsigned index, unsigned coresEach, const std::string& buses, const std::string& devices) {
    const unsigned cpus = ((1u << coresEach) - 1) << (index * coresEach);
    const unsigned node = 1u << index;
    const std::string number = std::to_string(index);
    std::string text = "<object type=\"Package\" os_index=\"" + number + "\"" + sets(cpus, node) + ">";
    text +=
        "<object type=\"NUMANode\" os_index=\"" + number + "\"" + sets(cpus, node) + " local_memory=\"1073741824\"/>";
    for (unsigned i = 0; i < coresEach; ++i) {
        const unsigned cpu = index * coresEach + i;
        text += "<object type=\"PU\" os_index=\"" + std::to_string(cpu) + "\"" + sets(1u << cpu, node) + "/>";
    }
    text += "<object type=\"Bridge\" gp_index=\"" + std::to_string(nextIndex++) +
            "\" bridge_type=\"0-1\" depth=\"0\" bridge_pci=\"0000:" + buses + "\">";
    return text + devices + "</object></object>";
}

} // namespace

std::string twoPackagesXml(unsigned coresEach) {
    const unsigned cpus = (1u << (2 * coresEach)) - 1;
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><!DOCTYPE topology SYSTEM \"hwloc2.dtd\"><topology "
           "version=\"2.0\">"
           "<object type=\"Machine\" os_index=\"0\" allowed_cpuset=\"" +
           mask(cpus) + "\" allowed_nodeset=\"0x00000003\"" + sets(cpus, 3) + ">" +
           package(0, coresEach, "[00-02]", pciDevice("01", "0300 [1a03:2000]", "") + networkCard("02", "eth0")) +
           package(1, coresEach, "[80-82]", pciDevice("81", "0302 [10de:2330]", "") + networkCard("82", "ib0")) +
           "</object></topology>";
}

} // namespace mural
