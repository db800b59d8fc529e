#include "lamella/core/build_info.h"

#include <gtest/gtest.h>

#include <regex>

namespace lamella {
namespace {

TEST(BuildInfo, DescribesThisBuild) {
    const BuildInfo info = build_info();
    EXPECT_TRUE(std::regex_match(info.version, std::regex(R"(\d+\.\d+\.\d+)"))) << info.version;
    EXPECT_TRUE(std::regex_match(info.commit, std::regex(R"([0-9a-f]{12,}(\+changes)?|unknown)"))) << info.commit;
    EXPECT_TRUE(std::regex_match(info.compiler, std::regex(R"((GNU|Clang) \d+\.\d+\.\d+)"))) << info.compiler;
    EXPECT_NE(info.flags.find("-ffp-contract=off"), std::string::npos) << info.flags;
    EXPECT_EQ(info.flags.find("-W"), std::string::npos) << info.flags;
    EXPECT_FALSE(info.build_type.empty());
    EXPECT_FALSE(info.system.empty());
}

TEST(BuildInfo, NamesTheLibrariesWithTheirVersions) {
    bool has_hdf5 = false;
    for (const std::string& library : build_info().libraries) {
        EXPECT_TRUE(std::regex_match(library, std::regex(R"([\w+\-]+ \d[\w.]*)"))) << library;
        has_hdf5 |= library.starts_with("HDF5 ");
    }
    EXPECT_TRUE(has_hdf5);
}

}  // namespace
}  // namespace lamella
