// The topic `outputs`: joins the segments of the wall with the proofs of the head (operation `outputs`). Pure.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "common/base/clock.hpp"

namespace mural::page {

// Time within which the nodes usually prove their outputs after the first request of `outputs`. The second request then
// fetches the proofs.
inline constexpr int64_t kProofTimeNs = 200 * kNsPerMs;

// wall: result of the page's operation `wall`. Returns the argument `areas` of the head's operation: the places of all
// segments of the first canvas as fractions, by "canvas/segment". The head has pictures of that canvas alone.
[[nodiscard]] nlohmann::json areasOf(const nlohmann::json& wall);

// proofs: result of the head's operation `outputs`. Returns the data of the topic: one entry per segment whose picture
// somebody has proved.
[[nodiscard]] nlohmann::json outputList(const nlohmann::json& wall, const nlohmann::json& proofs);

} // namespace mural::page
