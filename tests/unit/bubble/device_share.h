#pragma once

// One foam on the devices of several processes: the GPU's program, run by its CPU twin, and by the GPU itself where
// there is one. Such tests have several processes share that GPU, which the program refuses.

#include "lamella/core/cuda.h"

#include "processes.h"

namespace lamella::bubble::test {

class OnDevices : public testing::TestWithParam<Device> {
protected:
    void SetUp() override {
        const std::string fault = cuda_fault();
        if (GetParam() == Device::kCuda && !fault.empty()) GTEST_SKIP() << fault;
    }
};

inline auto devices() { return testing::Values(Device::kCudaTwin, Device::kCuda); }
inline std::string device_name(const testing::TestParamInfo<Device>& info) {
    return info.param == Device::kCuda ? "Gpu" : "Twin";
}

}  // namespace lamella::bubble::test
