#include <algorithm>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/contact_sheet.hpp>
#include <samewhere/twin/studio.hpp>

namespace samewhere::twin {
namespace {

constexpr int kNumColumns = 4;
constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;

cv::Mat empty_sheet(int num_rows) {
  return cv::Mat(num_rows * kHeight_px, kNumColumns * kWidth_px, CV_8UC3);
}

// `place`: counts from the upper left, row by row.
void put(cv::Mat& sheet, int place, const cv::Mat& picture) {
  const cv::Rect there(place % kNumColumns * kWidth_px, place / kNumColumns * kHeight_px, kWidth_px,
                       kHeight_px);
  cv::Mat shrunk = sheet(there);
  cv::resize(picture, shrunk, there.size(), 0.0, 0.0, cv::INTER_AREA);
}

// How much there is to see: mean absolute curvature of the brightness.
double liveliness(const cv::Mat& picture) {
  cv::Mat curvature;
  cv::Laplacian(picture, curvature, CV_32F, 3);
  const cv::Scalar mean = cv::mean(cv::abs(curvature));
  return mean[0] + mean[1] + mean[2];
}

// Of the pairs that are nearly as alike as the best, one that shows more than a bare wall.
Impostor telling_pair(const Walkthrough& walk) {
  constexpr double kNearlyBest = 0.9;
  constexpr std::size_t kNumTried = 24;
  std::vector<Impostor> pairs = walk.truth().impostors;
  double best = 0.0;
  for (const auto& pair : pairs) best = std::max(best, pair.alike);
  std::erase_if(pairs, [&](const Impostor& pair) { return pair.alike < kNearlyBest * best; });
  if (pairs.empty()) {
    throw core::InputError("twin:" + walk.spec().preset +
                           ": no place of this building has a twin that the camera sees");
  }
  const Studio studio(walk, {});
  Impostor telling = pairs.front();
  double most = 0.0;
  for (std::size_t i = 0; i < pairs.size(); i += 1 + pairs.size() / kNumTried) {
    const double found = liveliness(studio.pictures(pairs[i].match).images.front());
    if (found <= most) continue;
    telling = pairs[i];
    most = found;
  }
  return telling;
}

}  // namespace

cv::Mat contact_sheet(const Walkthrough& walk) {
  constexpr int kNumPictures = 12;
  const Studio studio(walk, {});
  cv::Mat sheet = empty_sheet(kNumPictures / kNumColumns);
  for (int i = 0; i < kNumPictures; ++i) {
    const int frame = (walk.num_frames() - 1) * i / (kNumPictures - 1);
    put(sheet, i, studio.pictures(frame).images.front());
  }
  return sheet;
}

cv::Mat similarity_sheet(const Spec& spec) {
  Spec varied = spec;
  varied.similarity = 1.0;
  const Impostor pair = telling_pair(Walkthrough(varied, {}));
  cv::Mat sheet = empty_sheet(2);
  int column = 0;
  for (const double similarity : {0.0, 0.5, 0.9, 1.0}) {
    varied.similarity = similarity;
    const Walkthrough walk(varied, {});
    const Studio studio(walk, {});
    put(sheet, column, studio.pictures(pair.match).images.front());
    put(sheet, kNumColumns + column, studio.pictures(pair.query).images.front());
    ++column;
  }
  return sheet;
}

}  // namespace samewhere::twin
