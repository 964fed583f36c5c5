#include "tools/mural/network/probe_datagram.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "common/base/little_endian.hpp"

namespace mural::cli {

namespace {
constexpr std::string_view kMagic = "MURALNP1";
}

void writeProbe(const ProbeDatagram& probe, std::span<std::byte> into) {
    std::ranges::fill(into, std::byte{0});
    std::memcpy(into.data(), kMagic.data(), kMagic.size());
    storeLittle(into.data() + 8, probe.survey);
    into[16] = static_cast<std::byte>(probe.path);
    into[17] = std::byte{probe.fromDoctor};
    storeLittle(into.data() + 18, probe.sizeBytes);
}

std::optional<ProbeDatagram> readProbe(std::span<const std::byte> d) {
    if (d.size() < kMinProbeBytes || std::memcmp(d.data(), kMagic.data(), kMagic.size()) != 0) return {};
    ProbeDatagram p;
    p.survey = loadLittle<uint64_t>(d.data() + 8);
    p.path = static_cast<ProbePath>(d[16]);
    p.fromDoctor = d[17] == std::byte{1};
    p.sizeBytes = loadLittle<uint16_t>(d.data() + 18);
    if (p.path > ProbePath::LinkLocal || d[17] > std::byte{1} || p.sizeBytes != d.size()) return {};
    return p;
}

} // namespace mural::cli
