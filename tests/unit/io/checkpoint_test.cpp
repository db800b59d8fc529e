#include "lamella/io/checkpoint.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <zlib.h>

#include "sample_frames.h"
#include "temporary_folder.h"
#include <cstdio>

namespace lamella::test {
namespace {

using io::CheckpointReader;
using io::CheckpointWriter;

/// What a solver might save: values of all types, empty and larger than one HDF5 chunk.
struct State {
    std::vector<double> position = awkward_field("x", "m", 1, 300000).values;
    std::vector<double> nothing;
    std::vector<std::int64_t> id{std::numeric_limits<std::int64_t>::min(), 0, std::numeric_limits<std::int64_t>::max()};
    std::vector<std::int32_t> label{-1, 2, -3, 4};
    double time = 0.1;
    std::int64_t step = 42;
};

void save(const std::filesystem::path& path, const State& state) {
    CheckpointWriter out(path, "bubble");
    out.write("foam/position", state.position);
    out.write("foam/nothing", state.nothing);
    out.write("foam/contacts/id", state.id);
    out.write("label", state.label);
    out.write_value("time", state.time);
    out.write_value("step", state.step);
    out.commit();
}

void expect_state(const std::filesystem::path& path, const State& state) {
    CheckpointReader in(path, "bubble");
    std::vector<double> real{1.0, 2.0};
    in.read("foam/nothing", 0, real);
    EXPECT_TRUE(real.empty());
    in.read("foam/position", state.position.size(), real);
    EXPECT_EQ(bits(real), bits(state.position));
    std::vector<std::int64_t> id;
    in.read("foam/contacts/id", 3, id);
    EXPECT_EQ(id, state.id);
    std::vector<std::int32_t> label;
    in.read("label", 4, label);
    EXPECT_EQ(label, state.label);
    EXPECT_EQ(in.read_double("time"), state.time);
    EXPECT_EQ(in.read_integer("step"), state.step);
}

State small_state(std::int64_t step = 42) {
    State state;
    state.position.resize(20);
    state.step = step;
    return state;
}

TEST(Checkpoint, ReadsBackEveryKindOfValue) {
    const TemporaryFolder folder;
    save(folder / "c.h5", State());
    expect_state(folder / "c.h5", State());
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"c.h5"});
}

TEST(Checkpoint, HasTheSameBytesForTheSameState) {
    const TemporaryFolder folder;
    save(folder / "a.h5", State());
    save(folder / "b.h5", State());
    EXPECT_TRUE(contents_of(folder / "a.h5") == contents_of(folder / "b.h5"));
}

TEST(Checkpoint, DoesNotShowInWhatPartsAColumnCame) {
    const TemporaryFolder folder;
    const State state;
    save(folder / "whole.h5", state);
    const auto total = static_cast<std::int64_t>(state.position.size());
    for (const std::size_t length : {70'000U, 131'072U, 299'999U}) {
        CheckpointWriter out(folder / "parts.h5", "bubble");
        for (std::size_t at = 0; at < state.position.size(); at += length) {
            const std::span<const double> all = state.position;
            out.write_part("foam/position", all.subspan(at, std::min(length, all.size() - at)),
                           {static_cast<std::int64_t>(at), total});
        }
        out.write_part("foam/nothing", std::span<const double>(state.nothing), {0, 0});
        out.write("foam/contacts/id", state.id);
        out.write("label", state.label);
        out.write_value("time", state.time);
        out.write_value("step", state.step);
        out.commit();
        EXPECT_TRUE(contents_of(folder / "parts.h5") == contents_of(folder / "whole.h5")) << length;
    }
}

TEST(Checkpoint, ReadsStretchesOfAColumn) {
    const TemporaryFolder folder;
    const State state;
    save(folder / "c.h5", state);
    CheckpointReader in(folder / "c.h5", "bubble");
    const auto total = static_cast<std::int64_t>(state.position.size());
    std::vector<double> part;
    for (const auto& [first, count] : {std::pair{0, 10}, {131'000, 1'000}, {299'999, 1}, {300'000, 0}}) {
        in.read_stretch("foam/position", {first, total}, static_cast<std::size_t>(count), part);
        const auto from = state.position.begin() + first;
        EXPECT_EQ(bits(part), bits(std::vector<double>(from, from + count)));
    }
    EXPECT_ERROR(in.read_stretch("foam/position", {0, total + 1}, 3, part), InputError, "has 300000 values");
    EXPECT_ERROR(in.read_stretch("foam/position", {total - 1, total}, 2, part), InputError, "cannot be read");
}

TEST(Checkpoint, KeepsThePreviousOne) {
    const TemporaryFolder folder;
    for (std::int64_t step = 1; step <= 3; ++step) save(folder / "c.h5", small_state(step));
    expect_state(folder / "c.h5", small_state(3));
    expect_state(folder / "c.h5.previous", small_state(2));
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"c.h5", "c.h5.previous"}));
}

TEST(Checkpoint, ThatWasNotCommittedLeavesNoTrace) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state(1));
    {
        CheckpointWriter out(folder / "c.h5", "bubble");
        out.write_value("time", 2.0);
    }
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"c.h5"});
    expect_state(folder / "c.h5", small_state(1));
}

TEST(Checkpoint, RefusesNamesThatAreNoneOrUsedTwice) {
    const TemporaryFolder folder;
    CheckpointWriter out(folder / "c.h5", "bubble");
    for (const char* name : {"", "/a", "a/", "a//b", ".", "../a", "a/./b"}) {
        EXPECT_ERROR(out.write_value(name, 1.0), InputError, "cannot be the name");
    }
    out.write_value("a", 1.0);
    EXPECT_ERROR(out.write_value("a", 1.0), InputError, "\"a\" is written twice");
    out.commit();
    EXPECT_EQ(CheckpointReader(folder / "c.h5", "bubble").read_double("a"), 1.0);
}

TEST(Checkpoint, SaysWhichEntryIsNotWhatWasExpected) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    CheckpointReader in(folder / "c.h5", "bubble");
    std::vector<double> real;
    std::vector<std::int64_t> whole;
    EXPECT_ERROR(in.read("velocity", 1, real), InputError, "c.h5: has no entry \"velocity\"");
    EXPECT_ERROR(in.read("foam", 1, real), InputError, "has no entry \"foam\"");
    EXPECT_ERROR(in.read("foam/position", 21, real), InputError, "\"foam/position\" has 20 values, 21 were expected");
    EXPECT_ERROR(in.read("foam/position", std::size_t{1} << 60, real), InputError, "20 values");
    EXPECT_ERROR(in.read("label", 4, whole), InputError, "\"label\" does not hold 64-bit integers");
    EXPECT_ERROR(in.read("label", 4, real), InputError, "\"label\" does not hold 64-bit real numbers");
}

TEST(Checkpoint, OfAnotherSolverIsRefused) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    EXPECT_ERROR(CheckpointReader(folder / "c.h5", "melp"), InputError, "state of solver \"bubble\", not of \"melp\"");
}

TEST(Checkpoint, SaysThatAFileIsNone) {
    const TemporaryFolder folder;
    EXPECT_ERROR(CheckpointReader(folder / "none.h5", "bubble"), IoError, "none.h5: No such file");
    EXPECT_ERROR(CheckpointReader(folder.path(), "bubble"), InputError, "not a regular file");
    put(folder / "c.h5", "");
    EXPECT_ERROR(CheckpointReader(folder / "c.h5", "bubble"), InputError, "is not a checkpoint of lamella");
    put(folder / "c.h5", std::string(10000, 'x'));
    EXPECT_ERROR(CheckpointReader(folder / "c.h5", "bubble"), InputError, "is not a checkpoint of lamella");
    put(folder / "c.h5", "lamella checkpoint 7\nwhatever\n");
    EXPECT_ERROR(CheckpointReader(folder / "c.h5", "bubble"), InputError,
                 "of version \"7\"; this program reads version 1");
}

TEST(Checkpoint, CutAnywhereIsRefused) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    const std::string good = contents_of(folder / "c.h5");
    put(folder / "cut.h5", good);
    for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 499) {
        std::filesystem::resize_file(folder / "cut.h5", good.size() - length - 1);
        EXPECT_THROW(CheckpointReader(folder / "cut.h5", "bubble"), InputError) << length;
    }
    put(folder / "cut.h5", good + "x");
    EXPECT_ERROR(CheckpointReader(folder / "cut.h5", "bubble"), InputError, "is damaged: it has");
}

TEST(Checkpoint, WithAFlippedBitIsRefused) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    const std::string good = contents_of(folder / "c.h5");
    std::fstream file(folder / "c.h5", std::ios::in | std::ios::out | std::ios::binary);
    const auto put_byte = [&](std::size_t at, int byte) {
        file.seekp(static_cast<std::streamoff>(at));
        file.put(static_cast<char>(byte)).flush();
    };
    for (std::size_t i = 0; i < good.size(); i += 1 + good.size() / 1999) {
        put_byte(i, good[i] ^ (1 << i % 8));
        EXPECT_THROW(CheckpointReader(folder / "c.h5", "bubble"), InputError) << i;
        put_byte(i, good[i]);
    }
    expect_state(folder / "c.h5", small_state());
}

/// Changes bytes of the HDF5 part and seals the file again, as only somebody who wants to would.
std::string resealed(std::string file) {
    const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(file.data() + 512), file.size() - 512);
    char text[9];
    std::snprintf(text, sizeof text, "%08lx", crc);
    return file.replace(file.find("\ncrc32 ") + 7, 8, text);
}

TEST(Checkpoint, ChecksEveryDatasetOnItsOwnToo) {
    const TemporaryFolder folder;
    State state = small_state();
    state.position.assign(20, 1234567.0);
    save(folder / "c.h5", state);
    std::string file = contents_of(folder / "c.h5");
    const double value = 1234567.0;
    const std::size_t at = file.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
    ASSERT_NE(at, std::string::npos);
    file[at] = static_cast<char>(file[at] ^ 1);
    put(folder / "c.h5", resealed(file));
    CheckpointReader in(folder / "c.h5", "bubble");
    std::vector<double> real;
    EXPECT_ERROR(in.read("foam/position", 20, real), InputError, "\"foam/position\" cannot be read: damaged");
}

TEST(Checkpoint, BehindAValidSealMustStillBeOne) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    std::string file = contents_of(folder / "c.h5");
    std::string no_hdf5 = file;
    no_hdf5.replace(512, 8, "whatever");
    put(folder / "bad.h5", resealed(no_hdf5));
    EXPECT_ERROR(CheckpointReader(folder / "bad.h5", "bubble"), InputError, "is not an HDF5 file");
    std::string other = file;
    const std::size_t format = other.find("lamella checkpoint", 512);
    ASSERT_NE(format, std::string::npos);
    put(folder / "bad.h5", resealed(other.replace(format, 7, "gamella")));
    EXPECT_ERROR(CheckpointReader(folder / "bad.h5", "bubble"), InputError, "is not a checkpoint of lamella");
}

TEST(Checkpoint, OpensInPlainHdf5BehindItsSeal) {
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    EXPECT_TRUE(contents_of(folder / "c.h5").starts_with("lamella checkpoint 1\n"));
    const hid_t file = H5Fopen((folder / "c.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    const hid_t dataset = H5Dopen2(file, "foam/contacts/id", H5P_DEFAULT);
    std::int64_t id[3] = {};
    EXPECT_GE(H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, id), 0);
    EXPECT_EQ(id[2], std::numeric_limits<std::int64_t>::max());
    H5Dclose(dataset);
    const hid_t version = H5Aopen(file, "version", H5P_DEFAULT);
    std::int64_t number = 0;
    EXPECT_GE(H5Aread(version, H5T_NATIVE_INT64, &number), 0);
    EXPECT_EQ(number, 1);
    H5Aclose(version);
    H5Fclose(file);
}

TEST(Checkpoint, LeavesTheApplicationsHdf5ErrorHandlerAlone) {
    int calls = 0;
    const auto count = [](hid_t, void* calls_made) { return ++*static_cast<int*>(calls_made), herr_t{0}; };
    H5Eset_auto2(H5E_DEFAULT, count, &calls);
    const TemporaryFolder folder;
    save(folder / "c.h5", small_state());
    CheckpointReader in(folder / "c.h5", "bubble");
    EXPECT_THROW(in.read_double("none"), InputError);
    EXPECT_EQ(calls, 0);
    H5Dopen2(-1, "none", H5P_DEFAULT);
    EXPECT_EQ(calls, 1);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

TEST(Checkpoint, NamesPathAndReasonWhenItCannotWrite) {
    EXPECT_ERROR(CheckpointWriter("/nonexistent/c.h5", "bubble"), IoError,
                 "cannot write /nonexistent/c.h5: No such file");
}

}  // namespace
}  // namespace lamella::test
