// The choice of GPUs on machines that exist only as lists of devices.
#include "nodes/gl/gpu_choice.hpp"

#include <gtest/gtest.h>

#include <map>

namespace mural {
namespace {

TEST(GpuChoice, matchesEveryNameOfADevice) {
    const gl::EglDevice device{
        "device 1", "Some GPU", "/dev/dri/renderD129", "0000:65:00.0", "0a1b2c3d0a1b2c3d0a1b2c3d0a1b2c3d", false};
    for (const char* name : {"1", "GPU-0A1B2C3D-0a1b-2c3d-0a1b-2c3d0a1b2c3d", "0a1b2c3d0a1b2c3d0a1b2c3d0a1b2c3d",
                             "/dev/dri/renderD129", "0000:65:00.0"})
        EXPECT_TRUE(gl::matchesGpu(name, 1, device)) << name;
    for (const char* name : {"", "0", "11", "GPU-0a1b2c3d", "/dev/dri/renderD12", "0000:66:00.0", "Some GPU"})
        EXPECT_FALSE(gl::matchesGpu(name, 1, device)) << name;
    EXPECT_FALSE(gl::matchesGpu("GPU-", 1, {"device 1", "", "", "", "", true})) << "a device without names";
    EXPECT_EQ(gl::listOf({device, {"device 2", "", "", "", "", true}}),
              "0 (Some GPU, 0000:65:00.0, /dev/dri/renderD129, 0a1b2c3d0a1b2c3d0a1b2c3d0a1b2c3d), 1 (software)");
}

// EGL lists the GPUs in another order than their bus, and the software renderer last.
std::vector<gl::EglDevice> fourGpus() {
    return {{"device 0", "B", "/dev/dri/renderD130", "0000:41:00.0", "bb000000000000000000000000000001", false},
            {"device 1", "A", "/dev/dri/renderD128", "0000:01:00.0", "aa000000000000000000000000000001", false},
            {"device 2", "D", "/dev/dri/renderD131", "0000:c1:00.0", "dd000000000000000000000000000001", false},
            {"device 3", "C", "/dev/dri/renderD129", "0000:81:00.0", "cc000000000000000000000000000001", false},
            {"device 4", "", "", "", "", true}};
}

using Numbers = std::vector<size_t>;
const auto allOpen = [](size_t) { return true; };

TEST(GpuChoice, countsTheGpusOfAJobInTheOrderOfTheBus) {
    EXPECT_EQ(gl::selectGpus("0", fourGpus(), allOpen), Numbers{1});
    EXPECT_EQ(gl::selectGpus("2,1", fourGpus(), allOpen), (Numbers{3, 0}));
    EXPECT_EQ(gl::selectGpus("1,9", fourGpus(), allOpen), Numbers{0}) << "the host has no GPU 9";
}

TEST(GpuChoice, takesAllThatOpenIfDeviceGroupsHideTheOthers) {
    const auto half = [](size_t device) { return device == 2 || device == 3; };
    EXPECT_EQ(gl::selectGpus("0,1", fourGpus(), half), (Numbers{3, 2})) << "numbers that begin at 0";
    EXPECT_EQ(gl::selectGpus("2,3", fourGpus(), half), (Numbers{3, 2})) << "numbers of the host";
    EXPECT_EQ(gl::selectGpus("3", fourGpus(), [](size_t device) { return device == 2; }), Numbers{2});
}

TEST(GpuChoice, findsUuids) {
    EXPECT_EQ(gl::selectGpus("GPU-cc000000-0000-0000-0000-000000000001,GPU-AA", fourGpus(), allOpen), (Numbers{3, 1}));
    EXPECT_EQ(gl::selectGpus("GPU-aa,GPU-aa", fourGpus(), allOpen), Numbers{1});
    EXPECT_TRUE(gl::selectGpus("GPU-cc", fourGpus(), [](size_t device) { return device != 3; }).empty());
}

TEST(GpuChoice, selectsNoneForUnknownNames) {
    for (const char* names : {"NoDevFiles", "-1", "MIG-aa", "GPU-", ","})
        EXPECT_TRUE(gl::selectGpus(names, fourGpus(), allOpen).empty()) << names;
    EXPECT_TRUE(gl::selectGpus("0", {{"device 0", "", "", "", "", true}}, allOpen).empty());
}

TEST(GpuChoice, readsTheGpusOfAJobOnly) {
    std::map<std::string, std::string> values{{"CUDA_VISIBLE_DEVICES", "1"}, {"SLURM_JOB_GPUS", "3"}};
    const auto variable = [&](const char* name) -> const char* {
        const auto found = values.find(name);
        return found == values.end() ? nullptr : found->second.c_str();
    };
    EXPECT_EQ(gl::gpusOfJob(variable), "") << "a workstation";
    values["SLURM_JOB_ID"] = "12";
    EXPECT_EQ(gl::gpusOfJob(variable), "1");
    values["CUDA_VISIBLE_DEVICES"] = "";
    EXPECT_EQ(gl::gpusOfJob(variable), "3");
}

} // namespace
} // namespace mural
