#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/verify/pair_registration.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::verify {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const cv::Size kSize_px(640, 480);

Matrix3d shifted(double x_px, double y_px) {
  Matrix3d map = Matrix3d::Identity();
  map.topRightCorner<2, 1>() << x_px, y_px;
  return map;
}

// A little larger, turned by a few degrees, tilted and moved.
Matrix3d changed_view() {
  Matrix3d map;
  map << 1.08, -0.05, 20.0, 0.06, 1.05, -15.0, 1e-4, 5e-5, 1.0;
  return map;
}

// A wall of things that nothing else looks like.
struct Wall {
  cv::Mat grey;
  std::vector<Vector2d> things_px;
};

Wall wall(std::uint64_t seed, int num_things = 300) {
  core::Random random(seed);
  Wall wall{.grey = cv::Mat(kSize_px, CV_8UC1, cv::Scalar(120)), .things_px = {}};
  for (int i = 0; i < num_things; ++i) {
    const Vector2d at(random.uniform(10.0, 630.0), random.uniform(10.0, 470.0));
    const cv::Point corner(static_cast<int>(at.x()), static_cast<int>(at.y()));
    cv::rectangle(wall.grey, {corner, cv::Size(8 + static_cast<int>(random.index(24)), 20)},
                  cv::Scalar(static_cast<double>(random.index(256))), cv::FILLED);
    wall.things_px.push_back(at);
  }
  return wall;
}

// The wall, from where its pixels lie elsewhere; thing i has descriptor i of the world.
SeenView seen(const Wall& wall, const Matrix3d& here_from_wall, int missing_thing = -1) {
  const features::TestWorld world = features::test_world(3, 400);
  auto features = std::make_shared<features::Features>();
  features->descriptors = cv::Mat(0, 32, CV_8U);
  for (std::size_t i = 0; i < wall.things_px.size(); ++i) {
    const Vector2d pixel = mapped(here_from_wall, wall.things_px[i]);
    const bool is_inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < 639 && pixel.y() < 479;
    if (is_inside && static_cast<int>(i) != missing_thing)
      append_test_feature(*features, world, i, pixel, 0.0);
  }
  cv::Mat map(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) map.at<double>(i / 3, i % 3) = here_from_wall(i / 3, i % 3);
  SeenView view;
  cv::warpPerspective(wall.grey, view.grey, map, kSize_px);
  view.view = {core::FrameId(0), 0.0, features::test_rig(), kSize_px, features};
  return view;
}

core::Candidate candidate() { return {core::CandidateId(0), core::FrameId(9), core::FrameId(0)}; }

std::optional<PairView> registered(const SeenView& query, const SeenView& match) {
  return register_pair(query, match, agreeing_matches(candidate(), query.view, match.view, {}), {});
}

double correlation(const PairView& pair) {
  const cv::Mat a = pair.plane(PairPlane::kQuery);
  const cv::Mat b = pair.plane(PairPlane::kMatch);
  return a.dot(b) / std::sqrt(a.dot(a) * b.dot(b));
}

double amount(const PairView& pair, PairPlane plane) { return cv::sum(pair.plane(plane))[0]; }

TEST(RegisterPair, LaysTheMatchOntoTheQuery) {
  const Wall place = wall(1);
  const auto pair = registered(seen(place, shifted(0, 0)), seen(place, changed_view()));
  ASSERT_TRUE(pair);
  EXPECT_TRUE(pair->is_homography);
  EXPECT_EQ(pair->planes.size(), cv::Size(kPairSide_px, kNumPairPlanes * kPairSide_px));
  EXPECT_GT(correlation(*pair), 0.95);
  EXPECT_GT(pair->overlap_ratio, 0.75);
  EXPECT_GT(amount(*pair, PairPlane::kAgree), 500.0);
  EXPECT_EQ(amount(*pair, PairPlane::kOnlyQueryShows), 0.0);
  EXPECT_EQ(amount(*pair, PairPlane::kOnlyMatchShows), 0.0);
}

TEST(RegisterPair, WhatOneViewLacksIsADotWhereItShouldBe) {
  const Wall place = wall(2);
  constexpr int kThing = 7;
  const SeenView whole = seen(place, shifted(0, 0));
  const auto pair = registered(whole, seen(place, changed_view(), kThing));
  const auto other = registered(seen(place, shifted(0, 0), kThing), seen(place, changed_view()));
  ASSERT_TRUE(pair && other);
  const cv::Mat dot = pair->plane(PairPlane::kOnlyQueryShows);
  cv::Point at;
  double height = 0.0;
  cv::minMaxLoc(dot, nullptr, &height, nullptr, &at);
  EXPECT_NEAR(height, 1.0, 0.02);
  EXPECT_EQ(amount(*pair, PairPlane::kOnlyMatchShows), 0.0);
  // both ways round the same dot, up to a pixel of a plane
  cv::Point at_other;
  cv::minMaxLoc(other->plane(PairPlane::kOnlyMatchShows), nullptr, nullptr, nullptr, &at_other);
  EXPECT_EQ(amount(*other, PairPlane::kOnlyQueryShows), 0.0);
  EXPECT_LE(std::abs(at.x - at_other.x) + std::abs(at.y - at_other.y), 1);
}

TEST(RegisterPair, WhatTheOtherCannotSeeIsNotMissed) {
  const Wall place = wall(3);
  const auto pair = registered(seen(place, shifted(0, 0)), seen(place, shifted(-320, 0)));
  ASSERT_TRUE(pair);
  EXPECT_NEAR(pair->overlap_ratio, 0.5, 0.04);
  EXPECT_EQ(amount(*pair, PairPlane::kOnlyQueryShows), 0.0);
  // the square is of the height, and fits what both see
  EXPECT_NEAR(pair->scale, 480.0 / kPairSide_px, 0.1);
  EXPECT_GT(amount(*pair, PairPlane::kSeenByBoth), 0.6 * kPairSide_px * kPairSide_px);
}

TEST(RegisterPair, OtherLightChangesLittle) {
  const Wall place = wall(4);
  const SeenView query = seen(place, shifted(0, 0));
  SeenView match = seen(place, shifted(0, 0));
  for (int row = 0; row < kSize_px.height; ++row) {
    cv::Mat line = match.grey.row(row);
    line.convertTo(line, CV_8U, 0.4 + 0.4 * row / kSize_px.height, 30.0);
  }
  const auto pair = registered(query, match);
  ASSERT_TRUE(pair);
  EXPECT_GT(correlation(*pair), 0.97);
}

TEST(RegisterPair, WhereThePicturesDifferTheyAreNotAlike) {
  const Wall place = wall(9);
  const SeenView query = seen(place, shifted(0, 0));
  SeenView match = seen(place, shifted(0, 0));
  const cv::Mat other = wall(10).grey;
  const cv::Rect poster(200, 150, 200, 150);
  other(poster).copyTo(match.grey(poster));
  const auto pair = registered(query, match);
  ASSERT_TRUE(pair);
  const cv::Mat alike = pair->plane(PairPlane::kAlike);
  const auto of_plane = [&](int px) { return static_cast<int>(px / pair->scale); };
  const int top = (kPairSide_px - of_plane(480)) / 2;  // the square is of the width
  const cv::Rect inside(of_plane(230), top + of_plane(180), of_plane(140), of_plane(90));
  const cv::Rect beside(of_plane(450), top + of_plane(180), of_plane(140), of_plane(90));
  const double where_the_same = cv::mean(alike(beside))[0];
  EXPECT_GT(where_the_same, 0.7);
  EXPECT_LT(cv::mean(alike(inside))[0], 0.7 * where_the_same);
  EXPECT_EQ(cv::norm(alike.rowRange(0, top - 1), cv::NORM_INF), 0.0);
}

TEST(RegisterPair, TheSamePairGivesTheSameBitsAndLeavesItsPicturesAlone) {
  const Wall place = wall(5);
  const SeenView query = seen(place, shifted(0, 0));
  const SeenView match = seen(place, changed_view());
  const cv::Mat before = query.grey.clone();
  const auto first = registered(query, match);
  const auto second = registered(query, match);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(
      std::memcmp(first->planes.data, second->planes.data, first->planes.total() * sizeof(float)),
      0);
}

TEST(RegisterPair, TooFewMatchesOrTooSmallAnOverlapAreNoPair) {
  const Wall place = wall(6);
  const SeenView query = seen(place, shifted(0, 0));
  EXPECT_FALSE(register_pair(query, query, {}, {}));
  EXPECT_FALSE(registered(query, seen(place, shifted(-600, 0))));
  EXPECT_FALSE(registered(query, seen(wall(7, 0), shifted(0, 0))));
}

TEST(RegisterPair, RefusesAPictureThatIsNotOfItsView) {
  const SeenView query = seen(wall(8), shifted(0, 0));
  SeenView halved = query;
  cv::resize(query.grey, halved.grey, {}, 0.5, 0.5);
  EXPECT_THROW(register_pair(query, halved, {}, {}), core::ContractError);
}

geometry::PixelPairs pairs_under(const Matrix3d& map, std::uint64_t seed, int count) {
  core::Random random(seed);
  geometry::PixelPairs pairs;
  for (int i = 0; i < count; ++i) {
    pairs.first_px.emplace_back(random.uniform(50.0, 590.0), random.uniform(50.0, 430.0));
    pairs.second_px.push_back(mapped(map, pairs.first_px.back()));
  }
  return pairs;
}

TEST(RegisterPictures, FindsAnyGentleHomographyAmongWrongPairs) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    core::Random random(seed);
    Matrix3d map = Matrix3d::Identity();
    for (int i = 0; i < 4; ++i) map(i / 2, i % 2) += random.uniform(-0.15, 0.15);
    map(0, 2) = random.uniform(-100.0, 100.0);
    map(2, 0) = random.uniform(-2e-4, 2e-4);
    geometry::PixelPairs pairs = pairs_under(map, seed, 60);
    for (std::size_t i = 0; i < 20; ++i) pairs.second_px[i] += Vector2d(80.0, 60.0 + 2.0 * i);
    const auto found = register_pictures(pairs, kSize_px, random);
    ASSERT_TRUE(found && found->is_homography) << fmt::format("seed {}", seed);
    const Vector2d corner(60.0, 60.0);
    EXPECT_LT((mapped(found->second_from_first, corner) - mapped(map, corner)).norm(), 1.0)
        << fmt::format("seed {}", seed);
  }
}

TEST(RegisterPictures, WhatFoldsThePictureBecomesASimilarity) {
  Matrix3d mirrored = Matrix3d::Identity();
  mirrored(0, 0) = -1.0;
  mirrored(0, 2) = 640.0;
  core::Random random(1);
  const auto found = register_pictures(pairs_under(mirrored, 1, 40), kSize_px, random);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->is_homography);
  EXPECT_GT(found->second_from_first.determinant(), 0.0);
}

TEST(RegisterPictures, PairsOfOnePointAreNothing) {
  core::Random random(1);
  geometry::PixelPairs pairs;
  pairs.first_px.assign(20, Vector2d(100.0, 100.0));
  pairs.second_px.assign(20, Vector2d(200.0, 100.0));
  EXPECT_FALSE(register_pictures(pairs, kSize_px, random));
}

}  // namespace
}  // namespace samewhere::verify
