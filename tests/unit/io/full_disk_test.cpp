// What happens when the disk is full: a small tmpfs where the system lets us mount one (in a mount namespace of a
// thread, so it vanishes with the test), and a limit on the size of files anywhere.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/checkpoint.h"
#include "lamella/io/csv.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "sample_frames.h"
#include "temporary_folder.h"
#include <csignal>
#include <functional>
#include <thread>

namespace lamella::test {
namespace {

void save(const std::filesystem::path& path, std::size_t values) {
    io::CheckpointWriter out(path, "bubble");
    out.write("values", std::vector<double>(values, 0.5));
    out.commit();
}

void expect_saved(const std::filesystem::path& path, std::size_t values) {
    io::CheckpointReader in(path, "bubble");
    std::vector<double> read;
    in.read("values", values, read);
    EXPECT_EQ(read, std::vector<double>(values, 0.5));
}

/// Runs `body` with a file system of one MiB mounted on `folder`; false when the system does not allow it.
bool with_small_disk(const std::filesystem::path& folder, const std::function<void()>& body) {
    bool mounted = false;
    std::thread([&] {
        if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            mount("lamella-test", folder.c_str(), "tmpfs", 0, "size=1m") != 0) {
            return;
        }
        mounted = true;
        body();
    }).join();
    return mounted;
}

/// No file of this process grows beyond a size while this lives; write(2) then stops half-way and fails.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &old_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_{};
    void (*handler_)(int) = nullptr;
};

TEST(FullDisk, LeavesTheOldCheckpointAndNoTemporaryFile) {
    const TemporaryFolder folder;
    const bool mounted = with_small_disk(folder.path(), [&] {
        save(folder / "c.h5", 1000);
        save(folder / "c.h5", 2000);
        EXPECT_ERROR(save(folder / "c.h5", 500000), IoError, "/c.h5: No space left on device");
        EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"c.h5", "c.h5.previous"}));
        expect_saved(folder / "c.h5", 2000);
        expect_saved(folder / "c.h5.previous", 1000);
        save(folder / "c.h5", 3000);  // once there is room again, it goes on
        expect_saved(folder / "c.h5", 3000);
    });
    if (!mounted) GTEST_SKIP() << "mounting a small tmpfs needs root";
}

TEST(FullDisk, LeavesTheOldFrameAndNoTemporaryFile) {
    const TemporaryFolder folder;
    const bool mounted = with_small_disk(folder.path(), [&] {
        io::write_vtp(folder / "a.vtp", points_frame(10));
        EXPECT_ERROR(io::write_vtp(folder / "a.vtp", points_frame(100000)), IoError, "/a.vtp: No space left on device");
        EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a.vtp"});
        expect_same(io::read_vtp(folder / "a.vtp"), points_frame(10));
    });
    if (!mounted) GTEST_SKIP() << "mounting a small tmpfs needs root";
}

TEST(FullDisk, LeavesACsvFileThatEndsWithACompleteRow) {
    const TemporaryFolder folder;
    const bool mounted = with_small_disk(folder.path(), [&] {
        io::CsvWriter out(folder / "a.csv", {"a", "b"});
        std::size_t rows = 0;
        try {
            for (;; ++rows) out.append(std::vector<double>(2, 1.0 / 3.0));
        } catch (const IoError& error) {
            EXPECT_NE(std::string(error.what()).find("/a.csv: No space left on device"), std::string::npos);
        }
        const io::CsvTable table = io::read_csv(folder / "a.csv");
        EXPECT_EQ(table.rows.size(), rows);
        EXPECT_EQ(out.sync(), std::filesystem::file_size(folder / "a.csv"));
    });
    if (!mounted) GTEST_SKIP() << "mounting a small tmpfs needs root";
}

TEST(WriteThatStopsHalfWay, LeavesTheOldFilesAndNoTemporaryOnes) {
    const TemporaryFolder folder;
    save(folder / "c.h5", 1000);
    io::write_vtp(folder / "a.vtp", points_frame(10));
    {
        const FileSizeLimit limit(100000);
        EXPECT_ERROR(save(folder / "c.h5", 50000), IoError, "/c.h5: File too large");
        EXPECT_ERROR(io::write_vtp(folder / "a.vtp", points_frame(10000)), IoError, "/a.vtp: File too large");
    }
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"a.vtp", "c.h5"}));
    expect_saved(folder / "c.h5", 1000);
    expect_same(io::read_vtp(folder / "a.vtp"), points_frame(10));
}

TEST(WriteThatStopsHalfWay, IsCutOffACsvFileWhichThenGoesOn) {
    const TemporaryFolder folder;
    io::CsvWriter out(folder / "a.csv", {"a"});
    out.append({1.0});
    {
        const FileSizeLimit limit(10);
        EXPECT_ERROR(out.append({1.0 / 3.0}), IoError, "/a.csv: File too large");
        EXPECT_EQ(contents_of(folder / "a.csv"), "a\n1\n");
    }
    out.append({2.0});
    EXPECT_EQ(contents_of(folder / "a.csv"), "a\n1\n2\n");
}

}  // namespace
}  // namespace lamella::test
