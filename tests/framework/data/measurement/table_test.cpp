#include "framework/data/measurement/files/table.hpp"

#include <gtest/gtest.h>
#include <matio.h>

#include <random>
#include <sstream>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

Table read(const std::string& text, const std::vector<std::string>& wanted = {}) {
  std::istringstream stream(text);
  return readCsv(stream, "a.csv", wanted);
}

VectorXd makeVector(std::initializer_list<double> values) {
  return Eigen::Map<const VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

template <class Action>
std::string getError(const Action& action) {
  try {
    action();
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "no error";
}

std::string getCsvError(const std::string& text, const std::vector<std::string>& wanted = {}) {
  return getError([&] { read(text, wanted); });
}

TEST(Csv, HasNamesAndUnitsInItsHeader) {
  const Table table = read("t [ms],\"enc, 1 [mm]\", theta \n0,1.5,-2e-3\n1,+2, 3 \n");
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[0].name, "t");
  EXPECT_EQ(*table.columns[0].unit, "ms");
  EXPECT_EQ(table.columns[1].name, "enc, 1");
  EXPECT_EQ(*table.columns[1].unit, "mm");
  EXPECT_EQ(table.columns[2].name, "theta");
  EXPECT_FALSE(table.columns[2].unit);
  EXPECT_EQ(table.columns[1].values, makeVector({1.5, 2.0}));
  EXPECT_EQ(table.columns[2].values, makeVector({-2e-3, 3.0}));
}

TEST(Csv, UnitsMayStandInRoundBrackets) {
  const Table table = read("Zeit (ms),Force (N),torque (Ncm),x (left),f(t)\n0,1,2,3,4\n");
  ASSERT_EQ(table.columns.size(), 5U);
  EXPECT_EQ(table.columns[0].name, "Zeit");
  EXPECT_EQ(*table.columns[0].unit, "ms");
  EXPECT_EQ(table.columns[1].name, "Force");
  EXPECT_EQ(*table.columns[1].unit, "N");
  EXPECT_EQ(*table.columns[2].unit, "Ncm");
  EXPECT_EQ(table.columns[3].name, "x (left)");
  EXPECT_EQ(table.columns[4].name, "f(t)");
}

TEST(Csv, WithoutAHeaderHasColumnsByNumber) {
  for (const char* text :
       {"0,-0.002,-0.002\n1,2,3\n", "0 -0.002 -0.002\n1 2 3\n", "# made by x\n0;-0.002;-0.002\n1;2;3\n"}) {
    const Table table = read(text);
    ASSERT_EQ(table.columns.size(), 3U) << text;
    EXPECT_EQ(table.columns[0].name, "1");
    EXPECT_EQ(table.columns[2].name, "3");
    EXPECT_EQ(table.columns[1].values, makeVector({-0.002, 2.0})) << text;
  }
  EXPECT_EQ(read("5,6\n7,8\n", {"2"}).columns.front().values, makeVector({6.0, 8.0}));
}

TEST(Csv, SeparatorsLineEndsCommentsAndByteOrderMarks) {
  for (const char* text :
       {"t,y\n1,2\n3,4\n", "t;y\r\n1;2\r\n3;4\r\n", "t\ty\n1\t2\n3\t4", "\xef\xbb\xbft,y\n1,2\n3,4\n",
        "# made by x\n\nt,y\n# ,\n1,2\n\n\"3\",\"4\"\n\n", "t,y,\n1,2,\n3,4,\n", "t,y\n1,2,\n3,4,\n",
        "t,y,\n1,2\n3,4\n", ",t,y,,\n9,1,2,a,b\n9,3,4,,\n", " t , y \n 1 , 2 \n 3 , 4 \n"}) {
    const Table table = read(text);
    ASSERT_EQ(table.columns.size(), 2U) << text;
    EXPECT_EQ(table.columns[0].values, makeVector({1.0, 3.0})) << text;
    EXPECT_EQ(getColumn(table, "y").values, makeVector({2.0, 4.0})) << text;
  }
}

TEST(Csv, DecimalCommasBarsAndBlanks) {
  for (const char* text : {"t;y\n1;2,5\n3;4,5\n", "t\ty\n1,0\t2,5\n3,0\t4,5\n", "t|y\n1|2.5\n3|4.5\n",
                           "  t   y\n 1.0  2.5\n3.0\t 4.5 \n", "t y\n1 2,5\n3 4,5\n"}) {
    const Table table = read(text);
    ASSERT_EQ(table.columns.size(), 2U) << text;
    EXPECT_EQ(getColumn(table, "t").values, makeVector({1.0, 3.0})) << text;
    EXPECT_EQ(getColumn(table, "y").values, makeVector({2.5, 4.5})) << text;
  }
  EXPECT_EQ(getColumn(read("x [mm]\n1.5\n2\n"), "x").values, makeVector({1.5, 2.0}));
}

TEST(Csv, HasItsHeaderBelowABlockOfRemarksAndUnitsBelowThat) {
  for (const char* text :
       {"Recorder: bench 7\nDate;2026-11-26\nChannels;2;rate;100\n\nt;enc 1\n1;2,5\n3;4,5\n",
        "made by hand\nt,enc 1\n1,2.5\n3,4.5\n", "t;enc 1\ns;mm\n1;2,5\n3;4,5\n",
        "Date;2026-11-26\nFile\nt;enc 1\n[s];(mm)\n1;2,5\n3;4,5\n"}) {
    const Table table = read(text);
    ASSERT_EQ(table.columns.size(), 2U) << text;
    EXPECT_EQ(getColumn(table, "t").values, makeVector({1.0, 3.0})) << text;
    EXPECT_EQ(getColumn(table, "enc 1").values, makeVector({2.5, 4.5})) << text;
    const bool states_units = std::string(text).find("mm") != std::string::npos;
    EXPECT_EQ(getColumn(table, "enc 1").unit.value_or("none"), states_units ? "mm" : "none") << text;
  }
  EXPECT_EQ(getCsvError("made by hand\nt,y\n1,2\n1,x\n", {"y"}),
            "a.csv:4: column 'y' has 'x' which must be a number");
}

TEST(Csv, KeepsWhatIsWantedAndSkipsWhatIsNoNumber) {
  const std::string text = "Ovld,t,note,y,\n0,0,a,1,\n,1,b,2,\n";
  const Table wanted = read(text, {"t", "time", "y"});
  ASSERT_EQ(wanted.columns.size(), 2U);
  EXPECT_EQ(findColumn(wanted, "time"), nullptr);
  EXPECT_EQ(getError([&] { getColumn(wanted, "tt"); }),
            "a.csv: has no column 'tt'; did you mean 't'? (it has: t, y, Ovld, note)");
  const Table all = read(text);
  ASSERT_EQ(all.columns.size(), 2U);
  EXPECT_EQ(getError([&] { getColumn(all, "Ovld"); }),
            "a.csv:3: column 'Ovld' has an empty cell; must be a number");
  EXPECT_EQ(getError([&] { getColumn(all, "note"); }),
            "a.csv:2: column 'note' has 'a' which must be a number");
}

TEST(Csv, ErrorsNameLineColumnAndRule) {
  EXPECT_EQ(getCsvError(""), "a.csv: has no line; must have one that names the columns");
  EXPECT_EQ(getCsvError("t,y,t\n"), "a.csv:1: names the column 't' twice");
  EXPECT_EQ(getCsvError("t,y\n", {"t"}), "a.csv: column 't' has no samples");
  EXPECT_EQ(getCsvError("t,y\n", {}), "a.csv: column 't' has no samples");
  EXPECT_EQ(getCsvError("t,y\n0,1\n1\n"), "a.csv:3: has 1 cell, not as many as the header, which has 2");
  EXPECT_EQ(getCsvError("t,y\n0,1,2\n"), "a.csv:2: has more cells than the header, which has 2");
  EXPECT_EQ(getCsvError("t,y\n0,\n", {"y"}), "a.csv:2: column 'y' has an empty cell; must be a number");
  EXPECT_EQ(getCsvError("t,y\n0,1x\n", {"y"}), "a.csv:2: column 'y' has '1x' which must be a number");
  EXPECT_EQ(getCsvError("t,y\n0,NaN\n", {"y"}),
            "a.csv:2: column 'y' has 'NaN' which must be a finite number");
  EXPECT_EQ(getCsvError("t,y\n0,-inf\n", {"y"}),
            "a.csv:2: column 'y' has '-inf' which must be a finite number");
  EXPECT_EQ(getCsvError("t,y\n0,1e999\n", {"y"}),
            "a.csv:2: column 'y' has '1e999' which must be a number from 1e-308 to 1e308");
  EXPECT_EQ(getCsvError("t;y\n0;1.5\n1;1,5\n", {"y"}),
            "a.csv:3: column 'y' has '1,5' which must be a number with a decimal point, as those before");
  EXPECT_EQ(getCsvError("t;y\n0;1,5\n1;1.5\n", {"y"}),
            "a.csv:3: column 'y' has '1.5' which must be a number with a decimal comma, as those before");
  EXPECT_EQ(getCsvError("t;y\n0;1,500.25\n", {"y"}),
            "a.csv:2: column 'y' has '1,500.25' which must be a number with a decimal point, not a comma");
}

TEST(Csv, RefusesWhatIsNoText) {
  using namespace std::string_literals;
  EXPECT_EQ(getCsvError("\xff\xfet\0,\0y\0"s), "a.csv:1: is in UTF-16; save it in UTF-8");
  EXPECT_EQ(getCsvError("t,y\n0,1\n\0\1"s), "a.csv:3: has a NUL byte: is not text, or not in UTF-8");
  EXPECT_EQ(getCsvError(std::string(20 << 20, 'x')),
            "a.csv:1: has a line of more than 16 MiB: is not a table of text");
}

TEST(Csv, ReadsBackTheBitsThatWereWrittenOverManyBlocks) {
  std::mt19937_64 generator(1);
  const Eigen::Index count = 50000;
  std::vector<Column> columns{{"t", "s", VectorXd(count)}, {"a, \"b\"", {}, VectorXd(count)}};
  for (Column& column : columns) {
    for (double& value : column.values) {
      value = std::ldexp(static_cast<double>(generator()) - 9e18, static_cast<int>(generator() % 600) - 300);
    }
  }
  std::stringstream stream;
  writeTable(stream, columns);
  const Table table = readCsv(stream, "a.csv", {});
  ASSERT_EQ(table.columns.size(), 2U);
  EXPECT_EQ(*table.columns[0].unit, "s");
  EXPECT_EQ(table.columns[0].values, columns[0].values);
  EXPECT_EQ(table.columns[1].values, columns[1].values);
}

TEST(ReadTable, ErrorsNameTheFile) {
  const TestFolder folder;
  const auto getFileError = [&](const std::string& name) {
    return getError([&] { readTable(folder / name); }).substr(folder.getPath().string().size() + 1);
  };
  EXPECT_EQ(getFileError("nothing.csv"), "nothing.csv: does not exist");
  EXPECT_EQ(
      getFileError("noise.scale=2"),
      "noise.scale=2: does not exist; values of the experiment cannot be given here: write them into its "
      "file");
  EXPECT_EQ(getError([] { readTable("512"); }),
            "512: does not exist; a number for an option that can go without one is joined to it, as in "
            "--posterior=512");
  std::ofstream(folder / "a.xlsx") << "t";
  EXPECT_EQ(getFileError("a.xlsx"),
            "a.xlsx: must be a .csv, .txt, .tsv, .dat, .mat, .h5 or .hdf5 file, by its name");
  std::ofstream(folder / "a.mat") << "t,y\n1,2\n";
  EXPECT_EQ(getFileError("a.mat"), "a.mat: cannot be read as a MATLAB file");
  std::ofstream(folder / "a.h5") << "t,y\n1,2\n";
  EXPECT_EQ(getFileError("a.h5"), "a.h5: cannot be opened as an HDF5 file");
  std::filesystem::create_directory(folder / "b.csv");
  EXPECT_EQ(getFileError("b.csv"), "b.csv: is not a file");
}

TEST(Hdf5Table, ColumnsAreVectorsByTheirPath) {
  const TestFolder folder;
  Hdf5Writer file(folder / "a.h5");
  file.write("/t", makeVector({0.0, 1.0}));
  file.write("/run1/enc1", makeVector({2.0, 3.0}));
  file.writeAttribute("/run1/enc1", "units", "mm");
  file.writeSamples("/run1/row", makeVector({4.0, 5.0}));
  file.writeSamples("/run1/matrix", Eigen::MatrixXd::Ones(2, 2));
  file.write("/empty", VectorXd());
  file.write("/text", std::vector<std::string>{"a"});
  file.write("/integers", std::vector<std::int64_t>{6, 7});
  file.write("/bad", makeVector({0.0, std::nan("")}));
  file.close();
  const Table table = readTable(folder / "a.h5");
  ASSERT_EQ(table.columns.size(), 4U);
  EXPECT_EQ(getColumn(table, "run1/enc1").values, makeVector({2.0, 3.0}));
  EXPECT_EQ(*getColumn(table, "run1/enc1").unit, "mm");
  EXPECT_EQ(getColumn(table, "run1/row").values, makeVector({4.0, 5.0}));
  EXPECT_EQ(getColumn(table, "integers").values, makeVector({6.0, 7.0}));
  const auto getSkipped = [&](const std::string& name) {
    return getError([&] { readTable(folder / "a.h5", {name}); }).substr(folder.getPath().string().size() + 7);
  };
  EXPECT_EQ(getSkipped("run1/matrix"), "column 'run1/matrix' must have one dimension");
  EXPECT_EQ(getSkipped("text"), "column 'text' is not a dataset of real numbers");
  EXPECT_EQ(getSkipped("empty"), "column 'empty' has no samples");
  EXPECT_EQ(getSkipped("bad"), "column 'bad' has nan at row 2; must be a finite number");
}

class MatTable : public testing::TestWithParam<mat_ft> {};

void write(mat_t* file, const char* name, matio_classes kind, matio_types type, std::size_t rows,
           std::size_t columns, const void* data, int flags = 0) {
  std::size_t size[] = {rows, columns};
  matvar_t* variable = Mat_VarCreate(name, kind, type, 2, size, const_cast<void*>(data), flags);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
}

void writeMat(const std::filesystem::path& path, mat_ft version) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, version);
  const double numbers[] = {1.5, 2.5, 3.5, 4.5}, bad[] = {1.0, HUGE_VAL};
  double imaginary[] = {0.0, 1.0};
  const float singles[] = {0.5F, 1.5F};
  const std::int16_t shorts[] = {-3, 7};
  mat_complex_split_t parts{const_cast<double*>(numbers), imaginary};
  write(file, "column", MAT_C_DOUBLE, MAT_T_DOUBLE, 4, 1, numbers);
  write(file, "row", MAT_C_DOUBLE, MAT_T_DOUBLE, 1, 4, numbers);
  write(file, "single", MAT_C_SINGLE, MAT_T_SINGLE, 2, 1, singles);
  write(file, "shorts", MAT_C_INT16, MAT_T_INT16, 2, 1, shorts);
  write(file, "matrix", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 2, numbers);
  write(file, "complex", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 1, &parts, MAT_F_COMPLEX);
  write(file, "bad", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, 1, bad);
  write(file, "text", MAT_C_CHAR, MAT_T_UTF8, 1, 3, "abc");
  std::size_t one[] = {1, 1}, size[] = {3, 1};
  const char* fields[] = {"Time", "Data"};
  matvar_t* series = Mat_VarCreateStruct("series", 2, one, fields, 2);
  for (const char* field : fields) {
    Mat_VarSetStructFieldByName(
        series, field, 0,
        Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, const_cast<double*>(numbers), 0));
  }
  Mat_VarWrite(file, series, MAT_COMPRESSION_NONE);
  Mat_VarFree(series);
  Mat_Close(file);
}

TEST_P(MatTable, ColumnsAreRealVectorsAndThoseOfArraysAndStructures) {
  const TestFolder folder;
  writeMat(folder / "a.mat", GetParam());
  const Table table = readTable(folder / "a.mat");
  EXPECT_EQ(table.columns.size(), 8U);
  EXPECT_EQ(getColumn(table, "matrix(:,2)").values, makeVector({3.5, 4.5}));
  EXPECT_EQ(getColumn(table, "series.Data").values, makeVector({1.5, 2.5, 3.5}));
  const Table single = readTable(folder / "a.mat", {"series.Time", "matrix(:,1)"});
  EXPECT_EQ(single.columns.size(), 2U);
  EXPECT_EQ(getColumn(single, "matrix(:,1)").values, makeVector({1.5, 2.5}));
  EXPECT_EQ(getColumn(table, "column").values, makeVector({1.5, 2.5, 3.5, 4.5}));
  EXPECT_EQ(getColumn(table, "row").values, makeVector({1.5, 2.5, 3.5, 4.5}));
  EXPECT_EQ(getColumn(table, "single").values, makeVector({0.5, 1.5}));
  EXPECT_EQ(getColumn(table, "shorts").values, makeVector({-3.0, 7.0}));
  const auto getSkipped = [&](const std::string& name) {
    return getError([&] { readTable(folder / "a.mat", {name}); })
        .substr(folder.getPath().string().size() + 8);
  };
  EXPECT_EQ(getSkipped("matrix"), "column 'matrix' must be a vector, or one of its columns: 'matrix(:,1)'");
  EXPECT_EQ(getSkipped("complex"), "column 'complex' is complex; must be real");
  EXPECT_EQ(getSkipped("bad"), "column 'bad' has inf at row 2; must be a finite number");
  EXPECT_EQ(getSkipped("text"), "column 'text' is not an array of numbers");
}

INSTANTIATE_TEST_SUITE_P(Versions, MatTable, testing::Values(MAT_FT_MAT5, MAT_FT_MAT73));

}  // namespace
}  // namespace twinmap
