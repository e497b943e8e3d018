#include "orb_matches.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

namespace samewhere::bench {
namespace {

constexpr float kMaxRatio = 0.8F;
constexpr double kMaxError_px = 3.0;
constexpr double kConfidence = 0.99;
constexpr std::size_t kMinMatches = 8;  // one more than determines the matrix

struct PointPairs {
  std::vector<cv::Point2f> query;
  std::vector<cv::Point2f> match;
};

PointPairs distinct_pairs(const OrbFeatures& query, const OrbFeatures& match) {
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(query.descriptors, match.descriptors, nearest, 2);
  PointPairs pairs;
  for (const auto& two : nearest) {
    if (two.size() < 2 || two[0].distance >= kMaxRatio * two[1].distance) continue;
    pairs.query.push_back(query.points_px[static_cast<std::size_t>(two[0].queryIdx)]);
    pairs.match.push_back(match.points_px[static_cast<std::size_t>(two[0].trainIdx)]);
  }
  return pairs;
}

}  // namespace

OrbFeatures extract_orb(const cv::Mat& grey, int max_features) {
  OrbFeatures features;
  std::vector<cv::KeyPoint> keypoints;
  cv::ORB::create(max_features)
      ->detectAndCompute(grey, cv::noArray(), keypoints, features.descriptors);
  cv::KeyPoint::convert(keypoints, features.points_px);
  return features;
}

int count_inliers(const OrbFeatures& query, const OrbFeatures& match) {
  if (query.size() < 2 || match.size() < 2) return 0;
  const PointPairs pairs = distinct_pairs(query, match);
  if (pairs.query.size() < kMinMatches) return 0;
  cv::setRNGSeed(0);
  std::vector<unsigned char> is_inlier;
  const cv::Mat fundamental = cv::findFundamentalMat(pairs.query, pairs.match, cv::FM_RANSAC,
                                                     kMaxError_px, kConfidence, is_inlier);
  return fundamental.empty() ? 0 : cv::countNonZero(is_inlier);
}

}  // namespace samewhere::bench
