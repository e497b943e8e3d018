#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/name_stamps.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Names = std::vector<std::string>;

std::vector<std::string> ordered(Names names) {
  order_by_decimals(names);
  return names;
}

NameStamps stamps_of(const Names& names) { return stamps_from_names(names, 30.0, false); }

// Each less the first.
std::vector<double> since_first_s(const NameStamps& found) {
  std::vector<double> times_s;
  for (const double stamp_s : found.stamps_s) times_s.push_back(stamp_s - found.stamps_s.front());
  return times_s;
}

auto times(const std::vector<double>& expected_s) {
  std::vector<testing::Matcher<double>> all;
  for (const double time_s : expected_s) all.push_back(DoubleNear(time_s, 1e-6));
  return testing::ElementsAreArray(all);
}

TEST(NameStamps, DecimalNumbersAreOrderedByValue) {
  EXPECT_THAT(ordered({"1611234567.99.png", "1611234568.02.png", "1611234568.2.png",
                       "1611234568.05.png", "1611234568.23.png", "1611234569.png"}),
              ElementsAre("1611234567.99.png", "1611234568.02.png", "1611234568.05.png",
                          "1611234568.2.png", "1611234568.23.png", "1611234569.png"));
  EXPECT_THAT(ordered({"0.2.jpg", "0.05.jpg", "0.1.jpg"}),
              ElementsAre("0.05.jpg", "0.1.jpg", "0.2.jpg"));
  EXPECT_THAT(ordered({"cam0_1611234568.2.png", "cam0_1611234568.05.png"}),
              ElementsAre("cam0_1611234568.05.png", "cam0_1611234568.2.png"));
}

TEST(NameStamps, NumbersOfSectionsAreNoDecimals) {
  const Names sections = {"1.1.png", "1.2.png", "1.9.png", "1.10.png"};
  EXPECT_EQ(ordered(sections), sections) << "1.1 and 1.10 would be the same";
  const Names shots = {"take1.2.png", "take1.10.png"};
  EXPECT_EQ(ordered(shots), shots);
}

TEST(NameStamps, SecondsAndACountOfNanosecondsAreOrderedAsTheCount) {
  const Names names = {"12.5000000.png", "12.38000000.png", "12.971000000.png", "13.4000000.png"};
  EXPECT_EQ(ordered(names), names);
  EXPECT_THAT(stamps_of(names).stamps_s, times({12.005, 12.038, 12.971, 13.004}));
}

TEST(NameStamps, DecimalNumbersAreSeconds) {
  const NameStamps found =
      stamps_of({"1611234567.99.png", "1611234568.02.png", "1611234568.2.png"});
  EXPECT_THAT(found.stamps_s, times({1611234567.99, 1611234568.02, 1611234568.2}));
  EXPECT_THAT(found.remark, IsEmpty());
  EXPECT_THAT(stamps_of({"1305031229.100000.png", "1305031229.133333.png"}).stamps_s,
              times({1305031229.1, 1305031229.133333}));
}

TEST(NameStamps, NumbersSince1970AreRecognisedByTheirDigits) {
  EXPECT_THAT(since_first_s(stamps_of({"1611234567100.png", "1611234567133.png"})),
              times({0.0, 0.033}));
  EXPECT_THAT(since_first_s(stamps_of({"1611234567100000.png", "1611234567133333.png"})),
              times({0.0, 0.033333}));
  EXPECT_THAT(since_first_s(stamps_of({"1403636579763555584.png", "1403636579813555456.png"})),
              times({0.0, 0.05}));
  EXPECT_THAT(since_first_s(stamps_of({"1611234567.jpg", "1611234569.jpg"})), times({0.0, 2.0}));
  EXPECT_THAT(stamps_of({"1611234567100.png", "1611234567133.png"}).remark, IsEmpty());
}

TEST(NameStamps, FrameNumbersCountAsBefore) {
  EXPECT_THAT(
      stamps_of({"frame-000003.color.png", "frame-000004.color.png", "frame-000009.color.png"})
          .stamps_s,
      ElementsAre(3 / 30.0, 4 / 30.0, 9 / 30.0));
  EXPECT_THAT(stamps_of({"frame-000003.png", "frame-000004.png"}).remark, IsEmpty());
  EXPECT_THAT(stamps_of({"walk.0001.png", "walk.0002.png"}).stamps_s,
              ElementsAre(1 / 30.0, 2 / 30.0));
  EXPECT_THAT(stamps_of({"shot_010.0001.png", "shot_010.0002.png"}).stamps_s,
              ElementsAre(1 / 30.0, 2 / 30.0));
}

TEST(NameStamps, EachNthFrameCountsByItsNumberWithAWord) {
  const NameStamps found = stamps_of({"0000.png", "0030.png", "0060.png", "0120.png"});
  EXPECT_THAT(found.stamps_s, ElementsAre(0.0, 1.0, 2.0, 4.0));
  EXPECT_THAT(found.remark, AllOf(HasSubstr("rise by 30"), HasSubstr("frame numbers at 30")));
}

TEST(NameStamps, TimesAreRecognisedByTheirStep) {
  const NameStamps day =
      stamps_of({"071559923.png", "071559956.png", "071559989.png", "071600022.png"});
  EXPECT_THAT(since_first_s(day), times({0.0, 0.033, 0.066, 0.099})) << "over a minute";
  EXPECT_THAT(day.remark, AllOf(HasSubstr("rise by 33"), HasSubstr("time of day")));
  const NameStamps ms = stamps_of({"0.png", "33.png", "67.png", "100.png"});
  EXPECT_THAT(ms.stamps_s, times({0.0, 0.033, 0.067, 0.1}));
  EXPECT_THAT(ms.remark, AllOf(HasSubstr("rise by 33"), HasSubstr("milliseconds")));
  const NameStamps us = stamps_of({"100000.png", "133333.png", "166666.png"});
  EXPECT_THAT(us.stamps_s, times({0.1, 0.133333, 0.166666}));
  EXPECT_THAT(us.remark, AllOf(HasSubstr("33333"), HasSubstr("microseconds")));
  const NameStamps ns = stamps_of({"5012000000000.png", "5012033333333.png", "5012066666666.png"});
  EXPECT_THAT(ns.stamps_s, times({5012.0, 5012.033333333, 5012.066666666}));
  EXPECT_THAT(ns.remark, HasSubstr("nanoseconds"));
}

TEST(NameStamps, ACountOfManyDigitsIsAPosition) {
  const NameStamps found = stamps_of({"20210305153012.jpg", "20210305153013.jpg"});
  EXPECT_THAT(found.stamps_s, ElementsAre(0.0, 1 / 30.0));
  EXPECT_THAT(found.remark, IsEmpty());
}

TEST(NameStamps, AGivenRateTakesThemAsFrames) {
  const NameStamps found = stamps_from_names({"071534123.png", "071534156.png"}, 10.0, true);
  EXPECT_THAT(found.stamps_s, ElementsAre(0.0, 0.1));
  EXPECT_THAT(found.remark, IsEmpty());
  EXPECT_THAT(stamps_from_names({"3.png", "4.png"}, 10.0, true).stamps_s, ElementsAre(0.3, 0.4));
}

TEST(NameStamps, WhatIsNeitherCountsByPosition) {
  EXPECT_THAT(stamps_of({"door.png", "hall.png"}).stamps_s, ElementsAre(0.0, 1 / 30.0));
  EXPECT_THAT(stamps_of({"a_1.jpg", "a_2.jpg", "b_1.jpg"}).stamps_s,
              ElementsAre(0.0, 1 / 30.0, 2 / 30.0));
  const NameStamps wild = stamps_of({"7.png", "20013.png", "9000000.png", "9100000.png"});
  EXPECT_THAT(wild.stamps_s, ElementsAre(0.0, 1 / 30.0, 2 / 30.0, 3 / 30.0));
  EXPECT_THAT(wild.remark, AllOf(HasSubstr("rise by 100000"), HasSubstr("position")));
  EXPECT_THAT(stamps_of({"99999999999999999999999.png", "99999999999999999999999999.png"}).stamps_s,
              ElementsAre(0.0, 1 / 30.0));
}

}  // namespace
}  // namespace samewhere::input
