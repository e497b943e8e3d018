#include <algorithm>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/twin/front/contact_sheet.hpp>
#include <samewhere/twin/front/studio.hpp>

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

// Pictures of these frames, in their order, by the first camera.
std::vector<cv::Mat> pictures_of(const Walkthrough& walk, const std::vector<int>& frames,
                                 const Config& config) {
  const Studio studio(walk, config);
  const int num_pictures = static_cast<int>(frames.size());
  core::Progress progress("pictures", num_pictures);
  core::OrderedWorkers<cv::Mat> workers(num_pictures, num_threads(config), [&](int i) {
    return studio.pictures(frames[static_cast<std::size_t>(i)]).images.front();
  });
  std::vector<cv::Mat> pictures;
  while (const std::optional<cv::Mat> picture = workers.next()) {
    pictures.push_back(*picture);
    progress.update(static_cast<int>(pictures.size()));
    core::stop_if_interrupted();
  }
  return pictures;
}

// How much there is to see: mean absolute curvature of the brightness.
double liveliness(const cv::Mat& picture) {
  cv::Mat curvature;
  cv::Laplacian(picture, curvature, CV_32F, 3);
  const cv::Scalar mean = cv::mean(cv::abs(curvature));
  return mean[0] + mean[1] + mean[2];
}

// At most 24 pairs, evenly spread, of those that are nearly as alike as the best.
std::vector<AliasedPair> nearly_best_pairs(const Walkthrough& walk) {
  constexpr double kNearlyBest = 0.9;
  constexpr std::size_t kMostPairs = 24;
  std::vector<AliasedPair> pairs = watched_truth(walk).aliased_pairs;
  double best = 0.0;
  for (const auto& pair : pairs) best = std::max(best, pair.alike);
  std::erase_if(pairs, [&](const AliasedPair& pair) { return pair.alike < kNearlyBest * best; });
  if (pairs.empty()) {
    throw core::InputError("twin:" + walk.spec().preset +
                           ": no place of this building has a twin that the camera sees");
  }
  std::vector<AliasedPair> spread;
  for (std::size_t i = 0; i < pairs.size(); i += 1 + pairs.size() / kMostPairs) {
    spread.push_back(pairs[i]);
  }
  return spread;
}

// One of them that shows more than a bare wall.
AliasedPair telling_pair(const Walkthrough& walk, const Config& config) {
  const std::vector<AliasedPair> pairs = nearly_best_pairs(walk);
  std::vector<int> frames;
  for (const auto& pair : pairs) frames.push_back(pair.match);
  std::vector<double> found;
  for (const cv::Mat& picture : pictures_of(walk, frames, config)) {
    found.push_back(liveliness(picture));
  }
  const auto most = std::max_element(found.begin(), found.end());
  return pairs[static_cast<std::size_t>(most - found.begin())];
}

}  // namespace

cv::Mat contact_sheet(const Walkthrough& walk, const Config& config) {
  constexpr int kNumPictures = 12;
  std::vector<int> frames;
  for (int i = 0; i < kNumPictures; ++i) {
    frames.push_back((walk.num_frames() - 1) * i / (kNumPictures - 1));
  }
  cv::Mat sheet = empty_sheet(kNumPictures / kNumColumns);
  int place = 0;
  for (const cv::Mat& picture : pictures_of(walk, frames, config)) put(sheet, place++, picture);
  return sheet;
}

cv::Mat similarity_sheet(const Spec& spec, const Config& config) {
  Spec varied = spec;
  varied.similarity = 1.0;
  const AliasedPair pair = telling_pair(Walkthrough(varied, config), config);
  cv::Mat sheet = empty_sheet(2);
  int column = 0;
  for (const double similarity : {0.0, 0.5, 0.9, 1.0}) {
    varied.similarity = similarity;
    const Walkthrough walk(varied, config);
    const std::vector<cv::Mat> pictures = pictures_of(walk, {pair.match, pair.query}, config);
    put(sheet, column, pictures[0]);
    put(sheet, kNumColumns + column, pictures[1]);
    ++column;
  }
  return sheet;
}

}  // namespace samewhere::twin
