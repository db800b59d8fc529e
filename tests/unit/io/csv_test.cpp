#include "lamella/io/csv.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"

#include <gtest/gtest.h>

#include "sample_frames.h"
#include "temporary_folder.h"

namespace lamella::test {
namespace {

using io::CsvWriter;
using io::parse_csv;

TEST(CsvWriter, WritesShortExactNumbersAtOnce) {
    const TemporaryFolder folder;
    CsvWriter out(folder / "series.csv", {"time[s]", "total_area[m^2]"});
    out.append({0.1, 1.0 / 3.0});
    out.append({kNan, -kInfinity});
    out.append({1e22, -0.0});
    // Read while the writer is open: rows are with the system when append() returns.
    EXPECT_EQ(contents_of(folder / "series.csv"),
              "time[s],total_area[m^2]\n0.1,0.3333333333333333\nnan,-inf\n1e+22,-0\n");
    EXPECT_EQ(out.sync(), contents_of(folder / "series.csv").size());
}

TEST(CsvWriter, QuotesTextWhereNeeded) {
    const TemporaryFolder folder;
    CsvWriter out(folder / "events.csv", {"time[s]", "kind", "detail"});
    out.append_text({"1", "pop", "bubble 3, near \"the\" wall"});
    EXPECT_EQ(contents_of(folder / "events.csv"), "time[s],kind,detail\n1,pop,\"bubble 3, near \"\"the\"\" wall\"\n");
}

TEST(CsvWriter, ContinuesWhereTheCheckpointLeftIt) {
    const TemporaryFolder folder;
    std::uint64_t offset = 0;
    {
        CsvWriter out(folder / "series.csv", {"time[s]"});
        out.append({1.0});
        offset = out.sync();
        out.append({2.0});
    }
    CsvWriter out(folder / "series.csv", offset);
    out.append({3.0});
    EXPECT_EQ(contents_of(folder / "series.csv"), "time[s]\n1\n3\n");
    EXPECT_EQ(out.sync(), 12U);
}

TEST(CsvWriter, RefusesToContinueAFileThatWasChanged) {
    const TemporaryFolder folder;
    put(folder / "series.csv", "time[s]\n1\n22\n");
    EXPECT_ERROR(CsvWriter(folder / "series.csv", 14), InputError, "series.csv: has 13 bytes, but had 14");
    EXPECT_ERROR(CsvWriter(folder / "series.csv", 11), InputError, "no row ends at byte 11");
    EXPECT_ERROR(CsvWriter(folder / "none.csv", 11), IoError, "none.csv: No such file");
    EXPECT_EQ(contents_of(folder / "series.csv"), "time[s]\n1\n22\n");
}

TEST(CsvWriter, NamesPathAndReasonWhenItCannotWrite) {
    EXPECT_ERROR(CsvWriter("/nonexistent/a.csv", {"x"}), IoError, "cannot write /nonexistent/a.csv: No such file");
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    EXPECT_ERROR(CsvWriter("/dev/full", {"x"}), IoError, "cannot write /dev/full: No space left on device");
}

TEST(ReadCsv, ReadsBackExactlyWhatCsvWriterWrote) {
    const TemporaryFolder folder;
    std::vector<std::vector<double>> rows;
    CsvWriter out(folder / "a.csv", {"a", "b,c[m]", "d\"e"});
    for (std::size_t i = 0; i < 200; ++i) {
        rows.push_back({awkward_value(3 * i), awkward_value(3 * i + 1), awkward_value(3 * i + 2)});
        out.append(rows.back());
    }
    const io::CsvTable table = io::read_csv(folder / "a.csv");
    EXPECT_EQ(table.header, (std::vector<std::string>{"a", "b,c[m]", "d\"e"}));
    ASSERT_EQ(table.rows.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (std::isnan(rows[i][k])) {
                EXPECT_TRUE(std::isnan(table.rows[i][k]));
            } else {
                EXPECT_EQ(bits(std::vector{table.rows[i][k]}), bits(std::vector{rows[i][k]}));
            }
        }
    }
}

TEST(ReadCsv, FindsColumnsWithAndWithoutTheirUnit) {
    const io::CsvTable table = parse_csv("time[s],total_area[m^2],total\n", "a.csv");
    EXPECT_EQ(table.column("time"), 0);
    EXPECT_EQ(table.column("total_area[m^2]"), 1);
    EXPECT_EQ(table.column("total"), 2);
    EXPECT_EQ(table.column("area"), -1);
    EXPECT_TRUE(table.rows.empty());
}

TEST(ReadCsv, AcceptsOtherLineEndsBlankLinesAndAMissingLastOne) {
    const io::CsvTable table = parse_csv("a,b\r\n1,2\r\n\r\n\"3\",4", "a.csv");
    EXPECT_EQ(table.rows, (std::vector<std::vector<double>>{{1, 2}, {3, 4}}));
}

TEST(ReadCsv, SaysWhatIsWrongAndWhere) {
    EXPECT_ERROR(parse_csv("", "a.csv"), InputError, "a.csv: is empty");
    EXPECT_ERROR(parse_csv("a,b\n1,2\n3\n", "a.csv"), InputError, "a.csv:3: 1 values, but the header has 2 columns");
    EXPECT_ERROR(parse_csv("a,b\n1,2\n3,x\n", "a.csv"), InputError, "a.csv:3: b = \"x\" is not a number");
    EXPECT_ERROR(parse_csv("a,b\n\n1,\n", "a.csv"), InputError, "a.csv:3: b = \"\" is not a number");
    EXPECT_ERROR(parse_csv("a,\"b\n1,2\n", "a.csv"), InputError, "a.csv:1: a quoted field is not closed");
    EXPECT_ERROR(io::read_csv("/nonexistent.csv"), IoError, "cannot read /nonexistent.csv: No such file");
}

TEST(ReadFile, RefusesWhatIsTooLargeOrAFolder) {
    const TemporaryFolder folder;
    put(folder / "a", "12345");
    EXPECT_EQ(io::read_file(folder / "a", 5), "12345");
    EXPECT_ERROR(io::read_file(folder / "a", 4), InputError, "larger than the 4 bytes");
    EXPECT_ERROR(io::read_file(folder.path()), InputError, "is a folder");
    if (std::filesystem::exists("/dev/zero")) {
        EXPECT_ERROR(io::read_file("/dev/zero", 100000), InputError, "larger than the 100000 bytes");
    }
}

TEST(WriteFileAtomically, ReplacesTheFileAndCleansUpAfterAKilledRun) {
    const TemporaryFolder folder;
    put(folder / "a", "old");
    put(folder / "a.tmp", "half a file of a killed run");
    io::write_file_atomically(folder / "a", "new");
    EXPECT_EQ(contents_of(folder / "a"), "new");
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a"});
}

TEST(WriteFileAtomically, RefusesToReplaceAFolder) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a");
    EXPECT_ERROR(io::write_file_atomically(folder / "a", "new"), IoError, "not a regular file");
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a"});
}

TEST(ShortestText, ReadsBackAsTheSameDouble) {
    EXPECT_EQ(io::shortest_text(0.1), "0.1");
    EXPECT_EQ(io::shortest_text(100.0), "100");
    EXPECT_EQ(io::shortest_text(-kNan), "nan");
    EXPECT_EQ(io::shortest_text(kInfinity), "inf");
    EXPECT_EQ(io::shortest_text(-kInfinity), "-inf");
    for (std::size_t i = 0; i < 1000; ++i) {
        const double v = awkward_value(i);
        if (std::isnan(v)) continue;
        EXPECT_EQ(std::strtod(io::shortest_text(v).c_str(), nullptr), v);
    }
}

}  // namespace
}  // namespace lamella::test
