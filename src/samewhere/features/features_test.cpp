#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/features/orb.hpp>

namespace samewhere::features {
namespace {

// Smooth random blobs of several sizes: corners everywhere.
cv::Mat textured_image(std::uint64_t seed, int width = 640, int height = 480) {
  core::Random random(seed);
  cv::Mat image(height, width, CV_8U, cv::Scalar(128));
  for (int i = 0; i < 1500; ++i) {
    const cv::Point centre(static_cast<int>(random.uniform(0, width)),
                           static_cast<int>(random.uniform(0, height)));
    const cv::Size axes(static_cast<int>(random.uniform(3, 25)),
                        static_cast<int>(random.uniform(3, 25)));
    cv::ellipse(image, centre, axes, random.uniform(0, 180), 0, 360,
                cv::Scalar(random.uniform(0, 255)), -1);
  }
  return image;
}

core::Frame frame_of(const cv::Mat& image, bool is_calibrated = true) {
  core::Rig rig;
  if (is_calibrated) {
    rig.cameras = {
        core::PinholeRadtan{image.cols, image.rows, 500, 500, image.cols / 2.0, image.rows / 2.0}};
    rig.body_from_camera = {core::Rigid3{}};
  }
  core::Frame frame;
  frame.id = core::FrameId(0);
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.images = {image};
  return frame;
}

TEST(Orb, FindsAboutAsManyFeaturesAsAskedForAndSpreadsThem) {
  const View view = extract(frame_of(textured_image(1)), {});
  EXPECT_EQ(view.features->size(), 1000);
  EXPECT_EQ(view.features->descriptors.rows, 1000);
  std::set<std::pair<int, int>> eighths;
  for (const auto& pixel : view.features->raw_px) {
    eighths.insert({static_cast<int>(pixel.x() / 80), static_cast<int>(pixel.y() / 60)});
  }
  EXPECT_GE(eighths.size(), 60U) << "of 64 parts of the picture";
}

TEST(Orb, EvenSpreadTakesFromTheQuietHalfToo) {
  cv::Mat image = textured_image(2);
  cv::Mat quiet = image(cv::Rect(0, 0, 320, 480));
  quiet = quiet * 0.2 + 100;  // same structure, a fifth of the contrast
  const auto num_quiet = [&](int cell_px) {
    const View view = extract(frame_of(image), {.num_features = 500, .cell_px = cell_px});
    return std::count_if(view.features->raw_px.begin(), view.features->raw_px.end(),
                         [](const auto& p) { return p.x() < 320; });
  };
  EXPECT_GT(num_quiet(40), 150);
  EXPECT_LT(num_quiet(640), 100) << "one cell for the whole picture: the strongest corners only";
}

TEST(Orb, BlackTinyAndColourPicturesAreDecided) {
  EXPECT_EQ(extract(frame_of(cv::Mat::zeros(480, 640, CV_8U)), {}).features->size(), 0);
  EXPECT_EQ(extract(frame_of(cv::Mat(5, 7, CV_8U, cv::Scalar(9))), {}).features->size(), 0);
  cv::Mat colour;
  cv::cvtColor(textured_image(1), colour, cv::COLOR_GRAY2BGR);
  EXPECT_EQ(extract(frame_of(colour), {}).features->size(), 1000);
}

TEST(Orb, DepthBecomesAPointAndAVirtualRightPixel) {
  core::Frame frame = frame_of(textured_image(3));
  frame.depth_m = cv::Mat(480, 640, CV_32F, cv::Scalar(2.0));
  (*frame.depth_m)(cv::Rect(0, 0, 320, 480)) = 0.0F;
  const View view = extract(frame, {});
  for (int i = 0; i < view.features->size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto point = point_in_camera(view, i);
    if (std::lround(view.features->raw_px[k].x()) < 320) {
      EXPECT_FALSE(point);
      EXPECT_TRUE(std::isnan(view.features->right_x_px[k]));
    } else {
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->z(), 2.0, 1e-6);
      EXPECT_NEAR(point->x(), 2.0 * (view.features->raw_px[k].x() - 320.0) / 500.0, 1e-5);
      EXPECT_NEAR(view.features->raw_px[k].x() - view.features->right_x_px[k], 0.075 * 500 / 2.0,
                  1e-3);
    }
  }
}

// The same picture, turned by 10 degrees: where each pixel goes is known.
TEST(MatchPair, FindsTheSamePointsInATurnedPicture) {
  const cv::Mat first = textured_image(4);
  const cv::Mat turn = cv::getRotationMatrix2D({320, 240}, 10.0, 1.0);
  cv::Mat second;
  cv::warpAffine(first, second, turn, first.size());
  const View a = extract(frame_of(first), {});
  const View b = extract(frame_of(second), {});
  const auto matches = match_pair(a.features->descriptors, b.features->descriptors, {});
  int num_right = 0;
  for (const auto& match : matches) {
    const auto& p = a.features->raw_px[static_cast<std::size_t>(match.first)];
    const auto& q = b.features->raw_px[static_cast<std::size_t>(match.second)];
    const double x =
        turn.at<double>(0, 0) * p.x() + turn.at<double>(0, 1) * p.y() + turn.at<double>(0, 2);
    const double y =
        turn.at<double>(1, 0) * p.x() + turn.at<double>(1, 1) * p.y() + turn.at<double>(1, 2);
    // a corner of a coarse level is placed as coarsely
    const double scale = std::pow(1.2, a.features->octave[static_cast<std::size_t>(match.first)]);
    if (std::hypot(x - q.x(), y - q.y()) < 2.0 + 1.5 * scale) ++num_right;
  }
  EXPECT_GT(matches.size(), 300U);
  EXPECT_GT(num_right, 0.95 * static_cast<double>(matches.size()));
}

TEST(MatchPair, EmptyTablesHaveNoMatches) {
  const View view = extract(frame_of(textured_image(5)), {});
  const cv::Mat none(0, 32, CV_8U);
  EXPECT_TRUE(match_pair(view.features->descriptors, none, {}).empty());
  EXPECT_TRUE(match_pair(none, view.features->descriptors, {}).empty());
}

// As the definition says, one by one. Descriptors of few different bits have many equal distances.
TEST(MatchPair, PairsAreEachOthersFirstNearestAndClearlySo) {
  cv::RNG random(7);
  const Config config{.max_distance_bits = 20, .max_ratio = 0.9};
  std::size_t num_matches = 0;
  for (int trial = 0; trial < 20; ++trial) {
    cv::Mat first = cv::Mat::zeros(random.uniform(1, 90), 32, CV_8U);
    cv::Mat second = cv::Mat::zeros(random.uniform(1, 90), 32, CV_8U);
    random.fill(first.colRange(0, 5), cv::RNG::UNIFORM, 0, 256);
    random.fill(second.colRange(0, 5), cv::RNG::UNIFORM, 0, 256);
    const auto nearest = [](const unsigned char* one, const cv::Mat& all, int but) {
      int best = -1;
      for (int k = 0; k < all.rows; ++k)
        if (k != but &&
            (best < 0 || distance_bits(one, all.ptr(k)) < distance_bits(one, all.ptr(best))))
          best = k;
      return best;
    };
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < first.rows; ++i) {
      const int j = nearest(first.ptr(i), second, -1);
      const int next = nearest(first.ptr(i), second, j);
      const int bits = distance_bits(first.ptr(i), second.ptr(j));
      if (bits > 20 || nearest(second.ptr(j), first, -1) != i) continue;
      if (next < 0 || bits < 0.9 * distance_bits(first.ptr(i), second.ptr(next)))
        expected.emplace_back(i, j);
    }
    std::vector<std::pair<int, int>> found;
    for (const Match& match : match_pair(first, second, config)) {
      found.emplace_back(match.first, match.second);
      EXPECT_EQ(match.distance_bits,
                distance_bits(first.ptr(match.first), second.ptr(match.second)));
    }
    EXPECT_EQ(found, expected) << "trial " << trial;
    num_matches += found.size();
  }
  EXPECT_GT(num_matches, 100U);
}

TEST(MatchPair, APatternThatRepeatsIsRefusedByTheRatio) {
  const View view = extract(frame_of(textured_image(6)), {});
  cv::Mat twice;
  cv::vconcat(view.features->descriptors, view.features->descriptors, twice);
  EXPECT_TRUE(match_pair(view.features->descriptors, twice, {}).empty());
}

TEST(MatchPair, TheDistanceIsHowManyBitsDiffer) {
  cv::Mat tables(2, 32, CV_8U);
  cv::RNG random(3);
  for (int i = 0; i < 100; ++i) {
    random.fill(tables, cv::RNG::UNIFORM, 0, 256);
    int num_different = 0;
    for (int byte = 0; byte < tables.cols; ++byte) {
      const auto bits = static_cast<unsigned>(tables.at<std::uint8_t>(0, byte) ^
                                              tables.at<std::uint8_t>(1, byte));
      num_different += std::popcount(bits);
    }
    EXPECT_EQ(distance_bits(tables.ptr(0), tables.ptr(1)), num_different);
  }
  EXPECT_EQ(distance_bits(tables.ptr(0), tables.ptr(0)), 0);
}

TEST(PixelGrid, VisitsWhatLiesWithinTheRadiusAndNothingElse) {
  Features features;
  core::Random random(5);
  for (int i = 0; i < 500; ++i)  // undistorted, some lie outside the picture
    features.raw_px.emplace_back(random.uniform(-60.0, 700.0), random.uniform(-60.0, 540.0));
  features.undistorted_px = features.raw_px;
  const PixelGrid grid(features, {640, 480});
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d centre(random.uniform(-80.0, 720.0), random.uniform(-80.0, 560.0));
    const double radius_px = random.uniform(1.0, 90.0);
    std::set<int> visited;
    grid.visit_within(centre, radius_px,
                      [&](int index) { EXPECT_TRUE(visited.insert(index).second) << "twice"; });
    std::set<int> expected;
    for (int k = 0; k < features.size(); ++k) {
      const Eigen::Vector2f& pixel = features.undistorted_px[static_cast<std::size_t>(k)];
      if ((pixel.cast<double>() - centre).norm() <= radius_px) expected.insert(k);
    }
    EXPECT_EQ(visited, expected);
  }
}

TEST(MatchProjected, FindsEachFeatureWhereItIs) {
  const View view = extract(frame_of(textured_image(7)), {});
  std::vector<ProjectedPoint> points;
  for (int i = 0; i < view.features->size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector2d near =
        view.features->undistorted_px[k].cast<double>() + Eigen::Vector2d(2.0, -1.0);
    points.push_back({i, near, view.features->octave[k]});
  }
  const auto matches = match_projected(points, view.features->descriptors, view, 5.0, {});
  EXPECT_GT(matches.size(), 900U);
  for (const auto& match : matches) EXPECT_EQ(match.first, match.second);
}

TEST(MatchProjected, NothingBeyondTheRadius) {
  const View view = extract(frame_of(textured_image(8)), {.num_levels = 1});
  const Eigen::Vector2d far =
      view.features->undistorted_px[0].cast<double>() + Eigen::Vector2d(30.0, 0.0);
  const auto matches =
      match_projected({{0, far, 0}}, view.features->descriptors.row(0), view, 5.0, {});
  for (const auto& match : matches) EXPECT_NE(match.second, 0);
}

// As a forged map may have them: 65536 x 65536 cells are 0 in an int.
TEST(PixelGrid, StaysInsideItsMemoryWhateverTheSizeAndThePixels) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Features features;
  for (const float at : {kNaN, kInfinity, -kInfinity, 1e30F, -5.0F, 320.0F})
    features.undistorted_px.emplace_back(at, 100.0F);
  features.raw_px = features.undistorted_px;
  for (const cv::Size size_px :
       {cv::Size(1572840, 1572840), cv::Size(-7, 0), cv::Size(640, 480),
        cv::Size(std::numeric_limits<int>::max(), std::numeric_limits<int>::min())}) {
    const PixelGrid grid(features, size_px);
    std::vector<int> found;
    grid.visit_within({319.0, 101.0}, 5.0, [&](int feature) { found.push_back(feature); });
    EXPECT_EQ(found, std::vector<int>{5});
    grid.visit_within({kNaN, kInfinity}, 5.0, [](int) { ADD_FAILURE() << "is near nothing"; });
  }
}

TEST(OctaveAt, IsALevelOfThePyramidEvenOfNoRange) {
  EXPECT_EQ(octave_at(3, 0.0, 0.0, {}), 3);
  EXPECT_EQ(octave_at(40, 0.0, 0.0, {}), 7);
  EXPECT_EQ(octave_at(3, 1.0, 0.0, {}), 7);
  EXPECT_EQ(octave_at(3, 0.0, 1.0, {}), 0);
}

}  // namespace
}  // namespace samewhere::features
