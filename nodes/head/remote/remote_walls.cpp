#include "nodes/head/remote/remote_walls.hpp"

#include <sys/random.h>

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "transport/rsp/group_text.hpp"
#include "transport/tcp/socket_address.hpp"

namespace mural {

namespace {

uint64_t newRemoteSession() {
    uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random) random = static_cast<uint64_t>(monotonicNowNs());
    return random;
}

} // namespace

Result<std::unique_ptr<RemoteWalls>> RemoteWalls::open(const std::vector<std::string>& sends,
                                                       const std::string& secretFile, bool hasPairs, WallInput& input) {
    std::unique_ptr<RemoteWalls> walls(new RemoteWalls);
    const uint64_t session = newRemoteSession();
    for (const std::string& text : sends) {
        auto target = remote::wallTargetOf(text);
        if (!target) return target.error();
        auto secret = rsp::readSecret(target->secretFile.empty() ? secretFile : target->secretFile);
        if (!secret) return Error{"--send " + target->name + ": " + secret.error().message};
        remote::WallSenderConfig config;
        config.target = *target;
        config.secret = *secret;
        config.session = session;
        config.hasPairs = hasPairs;
        if (target->input != input::InputPermission::Off) {
            const WallInput::Source source{"remote wall " + target->name, "input=display", target->input};
            config.onEvent = [&input, source](const input::InputEvent& event) { input.take(source, event); };
            config.onGone = [&input] { input.releaseAll(); };
        }
        walls->walls_.push_back(std::make_unique<remote::WallSender>(std::move(config)));
    }
    return walls;
}

void RemoteWalls::offer(int64_t frame, const std::shared_ptr<const OwnedPicture>& picture) {
    for (const auto& wall : walls_) wall->offer(static_cast<uint64_t>(frame), picture);
}

void RemoteWalls::finish(Deadline deadline) {
    for (const auto& wall : walls_)
        if (!wall->finish(deadline))
            log::debug(log::Topic::Output, "a remote wall has not shown the last picture in time");
    end();
}

std::vector<std::string> RemoteWalls::explain() const {
    std::vector<std::string> lines;
    for (const auto& wall : walls_) {
        const remote::WallTarget& target = wall->target();
        lines.push_back(
            fmt::format("remote wall {}: pictures go to {}, in tiles of {} pixels with {}, at most {} per second",
                        target.name, endpointText(target.host, target.port), target.tile, target.codec, target.rate));
    }
    return lines;
}

void RemoteWalls::end() {
    for (const auto& wall : walls_) wall->requestEnd();
    for (const auto& wall : walls_) wall->end();
}

} // namespace mural
