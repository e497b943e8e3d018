#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/mat_file.hpp>
#include <samewhere/input/place_matrix.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using core::PlaceTruth;
using testing::AllOf;
using testing::HasSubstr;

// Writes variables by libmatio.
class MatFile : public testing::Test {
 protected:
  struct CloseMatlab {
    void operator()(mat_t* mat) const { Mat_Close(mat); }
  };
  using Matlab = std::unique_ptr<mat_t, CloseMatlab>;

  Matlab create(mat_ft version = MAT_FT_MAT5) const {
    return Matlab(Mat_CreateVer(file().c_str(), nullptr, version));
  }

  static void add(const Matlab& mat, matvar_t* variable, matio_compression compression) {
    ASSERT_EQ(Mat_VarWrite(mat.get(), variable, compression), 0);
    Mat_VarFree(variable);
  }

  // Values column by column, as MATLAB has them.
  static void add_doubles(const Matlab& mat, const char* name, std::vector<double> values,
                          std::array<std::size_t, 2> size,
                          matio_compression compression = MAT_COMPRESSION_NONE) {
    add(mat, Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0),
        compression);
  }

  // 5 x 5 with two entries, at rows 3 and 4 of columns 0 and 1.
  static void add_sparse(const Matlab& mat, matio_compression compression) {
    std::vector<mat_uint32_t> rows{3, 4};
    std::vector<mat_uint32_t> columns{0, 1, 2, 2, 2, 2};
    std::vector<double> values{1.0, 1.0};
    mat_sparse_t sparse{};
    sparse.nzmax = 2;
    sparse.ir = rows.data();
    sparse.nir = 2;
    sparse.jc = columns.data();
    sparse.njc = 6;
    sparse.ndata = 2;
    sparse.data = values.data();
    std::array<std::size_t, 2> size{5, 5};
    add(mat, Mat_VarCreate("truth", MAT_C_SPARSE, MAT_T_DOUBLE, 2, size.data(), &sparse, 0),
        compression);
  }

  std::string complaint_about_file() const {
    return complaint([this] { read_mat_matrix(file()); });
  }

  std::filesystem::path file() const { return folder_.at("NewCollegeGroundTruth.mat"); }

  TestFolder folder_;
};

TEST_F(MatFile, RowsAndColumnsAreNotMixedUp) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    add_doubles(create(), "truth", {0, 1, 2, 0, 0, 0, 0, 0, 0}, {3, 3}, compression);
    const core::PlaceTruthMatrix places = read_mat_matrix(file());
    EXPECT_EQ(places.num_frames, 3);
    EXPECT_EQ(places.at(1, 0), PlaceTruth::kSame);
    EXPECT_EQ(places.at(2, 0), PlaceTruth::kNear);
    EXPECT_EQ(places.at(0, 1), PlaceTruth::kDifferent);
  }
}

TEST_F(MatFile, ASparseMatrixIsRead) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    add_sparse(create(), compression);
    const core::PlaceTruthMatrix places = read_mat_matrix(file());
    ASSERT_EQ(places.num_frames, 5);
    int num_same = 0;
    for (const PlaceTruth place : places.values) num_same += place == PlaceTruth::kSame ? 1 : 0;
    EXPECT_EQ(num_same, 2);
    EXPECT_EQ(places.at(3, 0), PlaceTruth::kSame);
    EXPECT_EQ(places.at(4, 1), PlaceTruth::kSame);
  }
}

TEST_F(MatFile, LogicalAndSmallIntegersAreRead) {
  std::vector<std::uint8_t> values{0, 1, 1, 0};
  std::array<std::size_t, 2> size{2, 2};
  for (const int flags : {0, static_cast<int>(MAT_F_LOGICAL)}) {
    add(create(),
        Mat_VarCreate("truth", MAT_C_UINT8, MAT_T_UINT8, 2, size.data(), values.data(), flags),
        MAT_COMPRESSION_ZLIB);
    EXPECT_EQ(read_mat_matrix(file()).at(1, 0), PlaceTruth::kSame);
  }
}

TEST_F(MatFile, TheMatrixIsFoundAmongOthersByNameOrShape) {
  {
    const Matlab mat = create();
    add_doubles(mat, "GPS", {1, 2, 3, 4, 5, 6}, {3, 2});
    add_doubles(mat, "other", {5, 5, 5, 5}, {2, 2});
    add_doubles(mat, "truth", {0, 1, 0, 0}, {2, 2});
  }
  EXPECT_EQ(read_mat_matrix(file()).at(1, 0), PlaceTruth::kSame);
  {
    const Matlab mat = create();
    add_doubles(mat, "GPS", {1, 2, 3, 4, 5, 6}, {3, 2});
    add_doubles(mat, "new_GT", {0, 1, 0, 0}, {2, 2});
  }
  EXPECT_EQ(read_mat_matrix(file()).at(1, 0), PlaceTruth::kSame);
  {
    const Matlab mat = create();
    add_doubles(mat, "one", {0, 1, 0, 0}, {2, 2});
    add_doubles(mat, "two", {0, 1, 0, 0}, {2, 2});
  }
  EXPECT_THAT(complaint_about_file(), HasSubstr("several square matrices: one (2 x 2), two"));
}

TEST_F(MatFile, NoSquareMatrixIsRefused) {
  add_doubles(create(), "truth", {0, 1, 0, 0, 0, 0}, {3, 2});
  EXPECT_THAT(complaint_about_file(),
              HasSubstr("no square matrix of numbers; found truth (3 x 2)"));
  create();
  EXPECT_THAT(complaint_about_file(), HasSubstr("no square matrix of numbers; found none"));
}

TEST_F(MatFile, OtherValuesAreRefused) {
  add_doubles(create(), "truth", {0, 7, 0, 0}, {2, 2});
  EXPECT_THAT(complaint_about_file(), HasSubstr("found the value 7, expected 0"));
  add_doubles(create(), "truth", {0, std::nan(""), 0, 0}, {2, 2});
  EXPECT_THAT(complaint_about_file(), HasSubstr("found the value nan"));
}

TEST_F(MatFile, OtherFilesAndVersionsAreRefused) {
  folder_.write("NewCollegeGroundTruth.mat", "0 1\n1 0\n");
  EXPECT_THAT(complaint_about_file(), HasSubstr("is no MATLAB file of version 5 to 7"));
  std::string newer(200, '\0');
  newer.replace(124, 4, std::string("\0\2IM", 4));
  folder_.write("NewCollegeGroundTruth.mat", newer);
  EXPECT_THAT(complaint_about_file(), HasSubstr("another version, expected 5 to 7"));
}

TEST_F(MatFile, AMatrixOfManyRowsIsRefusedBeforeMemoryIsTaken) {
  add_sparse(create(), MAT_COMPRESSION_NONE);
  std::string bytes = core::read_file(file());
  const std::string size("\5\0\0\0\5\0\0\0", 8);
  const std::size_t at = bytes.find(size);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 8, std::string("\xff\xff\xff\x7f\xff\xff\xff\x7f", 8));
  folder_.write("NewCollegeGroundTruth.mat", bytes);
  EXPECT_THAT(complaint_about_file(), HasSubstr("2147483647 rows, expected at most 20000"));
}

TEST_F(MatFile, AFileThatIsCutShortIsRefused) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    add_doubles(create(), "truth", {0, 1, 0, 0}, {2, 2}, compression);
    for (std::uintmax_t length = std::filesystem::file_size(file()); length-- > 0;) {
      std::filesystem::resize_file(file(), length);
      if (length == 128) continue;  // a file without variables
      EXPECT_THAT(complaint_about_file(), HasSubstr("NewCollegeGroundTruth.mat: is ")) << length;
    }
  }
}

TEST_F(MatFile, DamagedBytesAreReadOrRefused) {
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    add_sparse(create(), compression);
    const std::string whole = core::read_file(file());
    core::Random rng(7);
    for (int trial = 0; trial < 100; ++trial) {
      std::string bytes = whole;
      for (int i = 0; i < 3; ++i)
        bytes[128 + rng.index(bytes.size() - 128)] = static_cast<char>(rng.index(256));
      std::ofstream(file(), std::ios::binary) << bytes;  // core's functions wait for the disk
      try {
        const core::PlaceTruthMatrix places = read_mat_matrix(file());
        EXPECT_EQ(places.values.size(),
                  static_cast<std::size_t>(places.num_frames) * places.num_frames);
      } catch (const core::InputError&) {
        // one line, and the program goes on
      }
    }
  }
}

TEST_F(MatFile, IsAPublishedMatrix) {
  add_doubles(create(), "truth", {0, 0, 1, 0}, {2, 2});
  EXPECT_EQ(published_matrix(folder_.root()), file());
  const core::PlaceTruthMatrix places = read_published_matrix(file());
  EXPECT_EQ(places.at(0, 1), PlaceTruth::kSame);
  EXPECT_EQ(places.at(1, 0), PlaceTruth::kSame);  // the other triangle
}

}  // namespace
}  // namespace samewhere::input
