// Every file of tests/data/malformed_meshes is refused with one line that names the file and says what is wrong: the text
// after "expect: " on one of its first two lines.

#include "lamella/core/error.h"
#include "lamella/io/mesh_files.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lamella::io {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() { return fs::path(LAMELLA_SOURCE_DIR) / "tests/data/malformed_meshes"; }

std::string error_of(const fs::path& path) {
    try {
        read_films(path);
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "accepted";
}

std::string expectation_of(const fs::path& path) {
    const std::string contents = test::contents_of(path), mark = "expect: ";
    const std::size_t begin = contents.find(mark);
    return begin == std::string::npos ? "" : contents.substr(begin + mark.size(), contents.find('\n', begin) - begin - mark.size());
}

TEST(MalformedMeshes, AreEachRefusedInOneHelpfulLine) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(data_folder())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::map<std::string, int> of_suffix;
    for (const fs::path& path : files) {
        ++of_suffix[path.extension().string()];
        const std::string expected = expectation_of(path), error = error_of(path);
        ASSERT_FALSE(expected.empty()) << path;
        EXPECT_TRUE(error.starts_with(path.string() + ":")) << error;
        EXPECT_NE(error.find(expected), std::string::npos) << path.filename() << "\n  says: " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        EXPECT_LT(error.size(), path.string().size() + 400) << error;
    }
    EXPECT_GE(of_suffix[".fe"], 40);
    EXPECT_GE(of_suffix[".obj"], 12);
    EXPECT_GE(of_suffix[".ply"], 12);
}

TEST(MalformedMeshes, AFolderAnotherSuffixAndNoFile) {
    EXPECT_NE(error_of(data_folder()).find("is no file of films"), std::string::npos);
    EXPECT_NE(error_of("/dev/zero").find("is no file of films"), std::string::npos);
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "folder.fe");
    EXPECT_NE(error_of(folder / "folder.fe").find("is a directory"), std::string::npos);
    EXPECT_THROW(read_films(data_folder() / "none.fe"), IoError);
}

}  // namespace
}  // namespace lamella::io
