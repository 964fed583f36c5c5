// The persistent UUID of a machine's node.
#include "transport/discovery/node_id.hpp"

#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>

namespace mural {
namespace {

class NodeId : public testing::Test {
protected:
    NodeId() : folder_(testing::TempDir() + "/mural_node_id_" + std::to_string(::getpid())) {
        std::filesystem::create_directories(folder_);
        places_ = {folder_ + "/machine-id", folder_ + "/state/mural"};
    }
    ~NodeId() override { std::filesystem::remove_all(folder_); }
    void machineId(const std::string& text) const { std::ofstream(places_.machineId) << text << "\n"; }
    [[nodiscard]] std::string idText() const {
        const auto id = nodeId(places_);
        return id ? uuidText(id.value()) : "error: " + id.error().message;
    }
    std::string folder_;
    NodeIdPlaces places_;
};

TEST_F(NodeId, isStableAndContainsNoMachineId) {
    machineId("0123456789abcdef0123456789abcdef");
    const std::string id = idText();
    EXPECT_EQ(idText(), id);
    EXPECT_EQ(id.find("0123"), std::string::npos) << id;
    EXPECT_EQ(id[14], '8');
    EXPECT_FALSE(std::filesystem::exists(places_.state));
    machineId("0123456789abcdef0123456789abcdee");
    EXPECT_NE(idText(), id);
}

TEST_F(NodeId, isCreatedAndStoredWithoutAMachineId) {
    for (const char* text : {"", "uninitialized", "0123"}) {
        machineId(text);
        std::filesystem::remove_all(places_.state);
        const std::string id = idText();
        EXPECT_EQ(id.size(), 36u) << id;
        EXPECT_EQ(idText(), id);
    }
    std::ofstream(places_.state + "/node-id") << "nonsense\n";
    const std::string id = idText();
    EXPECT_EQ(id.size(), 36u) << id;
    EXPECT_EQ(idText(), id);
}

TEST_F(NodeId, namesARemedyOnError) {
    std::ofstream(folder_ + "/state") << "a file in the way\n";
    EXPECT_NE(idText().find("XDG_STATE_HOME"), std::string::npos) << idText();
}

} // namespace
} // namespace mural
