// The values that completion finds on this machine: sessions, their operations and nodes, daemons, configuration files.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/mural/help/completion.hpp"

namespace mural::cli {

class MachineValues final : public LiveValues {
public:
    std::vector<Candidate> sessions() override;
    std::vector<Candidate> controlWords(const std::vector<std::string>& words, bool& takesFile) override;
    std::vector<Candidate> daemons() override;
    std::vector<Candidate> interfaces() override;
    std::vector<Candidate> layouts(const std::string& file) override;
    std::vector<Candidate> canvases(const std::string& file) override;
};

} // namespace mural::cli
