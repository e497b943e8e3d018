#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/odometry_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class OdometryFile : public testing::Test {
 protected:
  OdometryRows read(const std::string& text) {
    folder_.write("wheels.tum", text);
    return read_odometry(folder_.at("wheels.tum"));
  }

  // The message of the InputError, or "" if there is none.
  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }

  TestFolder folder_;
};

const std::string kFirst = "1.0 0 0 0 0 0 0 1";
const std::string kSecond = "1.1 0.5 0 0 0 0 0.6 0.8";

TEST_F(OdometryFile, CommentsAndColumnNamesAreNoRows) {
  const OdometryRows rows =
      read("# wheels\nstamp,tx,ty,tz,qx,qy,qz,qw\n" + kFirst + "\n\n" + kSecond + "\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[1].stamp_s, 1.1);
  EXPECT_EQ(rows[1].world_from_body.translation, Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_DOUBLE_EQ(rows[1].world_from_body.rotation.z(), 0.6);
  EXPECT_FALSE(rows[1].covariance);
}

TEST_F(OdometryFile, FourteenColumnsHaveVariancesOfTheIncrement) {
  const OdometryRows rows = read(kFirst + " 9 9 9 9 9 9\n" + kSecond + " 1 2 3 4 5 6\n");
  EXPECT_FALSE(rows[0].covariance) << "no row is before it";
  core::Vector6d variances;
  variances << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(rows[1].covariance.value(), core::Matrix6d(variances.asDiagonal()));
}

TEST_F(OdometryFile, TwentyNineColumnsHaveTheUpperTriangle) {
  const std::string triangle = " 2 .1 .2 .3 .4 .5 3 .6 .7 .8 .9 4 .11 .12 .13 5 .14 .15 6 .16 7";
  const OdometryRows rows = read(kFirst + triangle + "\n" + kSecond + triangle + "\n");
  const core::Matrix6d& covariance = rows[1].covariance.value();
  EXPECT_EQ(covariance, covariance.transpose());
  EXPECT_EQ(covariance.diagonal(), (core::Vector6d() << 2, 3, 4, 5, 6, 7).finished());
  EXPECT_EQ(covariance(0, 5), 0.5);
  EXPECT_EQ(covariance(1, 2), 0.6);
  EXPECT_EQ(covariance(4, 5), 0.16);
}

TEST_F(OdometryFile, AnErrorNamesFileLineAndValue) {
  const auto names = [&](const std::string& row, const std::string& value) {
    EXPECT_THAT(error_of(kFirst + "\n" + row + "\n"),
                AllOf(HasSubstr("wheels.tum, line 2"), HasSubstr(value)))
        << row;
  };
  names("1.0 0 0 0 0 0 0 1", "stamp 1.000000 after 1.000000");
  names("0.5 0 0 0 0 0 0 1", "stamp 0.500000 after 1.000000");
  names("1.1 0 0 0 0 0 0 0.9", "norm 0.9");
  names("1.1 0 0 0 0 0 0", "7 columns");
  names("1.1 0 nan 0 0 0 0 1", "nan");
  names("1.1 0 door 0 0 0 0 1", "door");
  names("1.1 0 0 0 0 0 0 1 1 1 1 1 1 1", "14 columns, expected 8");
}

TEST_F(OdometryFile, ACovarianceThatIsNoneIsAnError) {
  EXPECT_THAT(error_of(kFirst + " 1 1 1 1 1 1\n" + kSecond + " 1 1 -0.5 1 1 1\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("-0.5")));
  const std::string one = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";
  const std::string none = " 1 2 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";
  EXPECT_THAT(error_of(kFirst + one + "\n" + kSecond + none + "\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("eigenvalue -1")));
}

TEST_F(OdometryFile, AFileWithoutARowIsAnError) {
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("has no row"));
  EXPECT_THROW(read_odometry(folder_.root() / "none.tum"), core::InputError);
}

}  // namespace
}  // namespace samewhere::input
