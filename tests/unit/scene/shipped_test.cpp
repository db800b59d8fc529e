#include "lamella/scene/shipped.h"

#include "lamella/core/error.h"
#include "lamella/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace lamella::scene {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(LAMELLA_SOURCE_DIR) / "scenes";

/// Points LAMELLA_SCENES at a folder for one test.
class ShippedScenes : public ::testing::Test {
protected:
    void use(const fs::path& folder) { setenv("LAMELLA_SCENES", folder.c_str(), 1); }
    void TearDown() override { unsetenv("LAMELLA_SCENES"); }
};

std::string error_of(const std::string& name) {
    try {
        resolve_scene_path(name);
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "no error";
}

TEST_F(ShippedScenes, AreFoundByNameWithAndWithoutEnding) {
    use(kScenes);
    EXPECT_TRUE(fs::equivalent(resolve_scene_path("bubble/coarsening-2d"), kScenes / "bubble/coarsening-2d.toml"));
    EXPECT_TRUE(fs::equivalent(resolve_scene_path("bubble/coarsening-2d.toml"), kScenes / "bubble/coarsening-2d.toml"));
    EXPECT_EQ(resolve_scene_path((kScenes / "bubble/flow-2d.toml").string()), kScenes / "bubble/flow-2d.toml");
}

TEST_F(ShippedScenes, AreSuggestedWhenNearlyRight) {
    use(kScenes);
    EXPECT_EQ(error_of("bubble/coarsning-2d"),
              "\"bubble/coarsning-2d\" is neither a file nor the name of a shipped scene; did you mean "
              "bubble/coarsening-2d?");
    EXPECT_NE(error_of("flow-2d").find("did you mean bubble/flow-2d?"), std::string::npos);
    EXPECT_NE(error_of("melp/flow-2d-smal.toml").find("did you mean bubble/flow-2d-small?"), std::string::npos);
    EXPECT_NE(error_of("a-very-different-thing").find("`lamella scenes` lists them"), std::string::npos);
    EXPECT_NE(error_of("").find("neither a file"), std::string::npos);
}

TEST_F(ShippedScenes, AllHaveATitleAndAreAccepted) {
    use(kScenes);
    int seen = 0;
    for (const ShippedScene& shipped : shipped_scenes()) {
        EXPECT_NE(shipped.title.substr(0, 1), "(") << shipped.name << shipped.title;
        if (!shipped.name.starts_with("bubble/")) continue;
        const Scene scene = load_scene(shipped.path, {}, all_solvers());
        EXPECT_EQ(scene.title, shipped.title);
        EXPECT_TRUE(scene.notes.empty());
        ++seen;
    }
    EXPECT_GE(seen, 8);
}

TEST_F(ShippedScenes, ThatCannotBeReadSayWhy) {
    use(fs::path(LAMELLA_SOURCE_DIR) / "tests/data/malformed");
    const std::vector<ShippedScene> scenes = shipped_scenes();
    const auto broken =
        std::find_if(scenes.begin(), scenes.end(), [](const auto& s) { return s.name == "duplicate_key"; });
    ASSERT_NE(broken, scenes.end());
    EXPECT_TRUE(broken->title.starts_with("(cannot be read: ")) << broken->title;
    use("/no/such/folder");
    EXPECT_NO_THROW(shipped_scenes());
}

}  // namespace
}  // namespace lamella::scene
