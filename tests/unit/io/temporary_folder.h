#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace lamella::test {

/// An empty folder that is removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "lamella-io-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

inline std::string contents_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put(const std::filesystem::path& path, const std::string& contents) {
    std::ofstream(path, std::ios::binary) << contents;
}

/// Expects that `statement` throws `Error` and that its message holds `part`.
#define EXPECT_ERROR(statement, Error, part)                                                               \
    try {                                                                                                  \
        statement;                                                                                         \
        ADD_FAILURE() << "no error; " #Error " with \"" << (part) << "\" was expected";                    \
    } catch (const Error& error) {                                                                         \
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << "message: " << error.what(); \
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "more than one line";        \
    }

}  // namespace lamella::test
