// Every file of tests/data/malformed is refused with one line that names the file and says what is wrong: the text
// after "# expect: " on its first line.

#include "lamella/scene/scene.h"

#include <gtest/gtest.h>

#include "toy_solver.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace lamella::scene {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() { return fs::path(LAMELLA_SOURCE_DIR) / "tests/data/malformed"; }

std::string error_of(const fs::path& path) {
    try {
        load_scene(path, {}, toy::registry());
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "accepted";
}

std::string expectation_of(const fs::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    const std::string mark = "# expect: ";
    return line.starts_with(mark) ? line.substr(mark.size()) : "";
}

TEST(MalformedScenes, AreEachRefusedInOneHelpfulLine) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(data_folder()))
        if (entry.path().extension() == ".toml" && entry.path().stem() != "empty") files.push_back(entry.path());
    ASSERT_GE(files.size(), 35u);
    std::sort(files.begin(), files.end());
    for (const fs::path& path : files) {
        const std::string expected = expectation_of(path), error = error_of(path);
        ASSERT_FALSE(expected.empty()) << path;
        EXPECT_TRUE(error.starts_with(path.string() + ":")) << error;
        EXPECT_NE(error.find(expected), std::string::npos) << path.filename() << "\n  says: " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        EXPECT_LT(error.size(), path.string().size() + 400) << error;
    }
}

TEST(MalformedScenes, AnEmptyFileAndADirectoryAreRefused) {
    EXPECT_NE(error_of(data_folder() / "empty.toml").find("empty.toml: the scene is empty"), std::string::npos);
    EXPECT_NE(error_of(data_folder()).find("is a directory"), std::string::npos);
}

TEST(MalformedScenes, AMissingFileIsAnIoError) {
    EXPECT_THROW(load_scene(data_folder() / "no_such_scene.toml", {}, toy::registry()), IoError);
}

TEST(MalformedScenes, AFileWithoutEndIsRefused) {
    EXPECT_NE(error_of("/dev/zero").find("larger than 1 MiB"), std::string::npos);
}

}  // namespace
}  // namespace lamella::scene
