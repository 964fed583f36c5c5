// All remote walls of a session (mural run --send).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "nodes/head/input/wall_input.hpp"
#include "nodes/output/picture.hpp"
#include "nodes/remote_wall/wall_sender.hpp"

namespace mural {

class RemoteWalls {
public:
    // sends: values of --send. secretFile: of --secret. hasPairs: pictures contain both eyes (stackEyes). input:
    // outlives this object. Errors: a value or its secret cannot be read.
    static Result<std::unique_ptr<RemoteWalls>> open(const std::vector<std::string>& sends,
                                                     const std::string& secretFile, bool hasPairs, WallInput& input);

    // Offers the latest picture of the wall. Does not block; any thread.
    void offer(int64_t frame, const std::shared_ptr<const OwnedPicture>& picture);
    // Waits until the connected walls show the latest picture, or for the deadline; then ends all connections.
    void finish(Deadline deadline);
    void end();
    // Returns a line per wall, for --explain.
    [[nodiscard]] std::vector<std::string> explain() const;

private:
    RemoteWalls() = default;
    std::vector<std::unique_ptr<remote::WallSender>> walls_;
};

} // namespace mural
