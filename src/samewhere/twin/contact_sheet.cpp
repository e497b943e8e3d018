#include <opencv2/imgproc.hpp>

#include <samewhere/twin/contact_sheet.hpp>
#include <samewhere/twin/studio.hpp>

namespace samewhere::twin {

cv::Mat contact_sheet(const Walkthrough& walk) {
  constexpr int kNumColumns = 4;
  constexpr int kNumPictures = 12;
  const cv::Size small(320, 240);
  const Studio studio(walk, {});
  cv::Mat sheet(small.height * kNumPictures / kNumColumns, small.width * kNumColumns, CV_8UC3);
  for (int i = 0; i < kNumPictures; ++i) {
    const int frame = (walk.num_frames() - 1) * i / (kNumPictures - 1);
    const cv::Rect place({i % kNumColumns * small.width, i / kNumColumns * small.height}, small);
    cv::Mat shrunk = sheet(place);
    cv::resize(studio.pictures(frame).images.front(), shrunk, small, 0.0, 0.0, cv::INTER_AREA);
  }
  return sheet;
}

}  // namespace samewhere::twin
