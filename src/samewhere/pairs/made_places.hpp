#pragma once

#include <array>
#include <filesystem>
#include <string>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/random.hpp>

namespace samewhere::pairs {

// A folder of photographs, or those from one to another in their order (the first is 0, the last is
// in it): "photos:FOLDER?from=0&to=999". Neighbours may show one room, so that what is learnt from
// and what is measured on should be far from each other.
struct PhotoSource {
  std::filesystem::path folder;
  int first = 0;
  int last = 0;  // as large as an int can be: all
};

bool is_photos(const std::string& source);

// Throws InputError if the words behind the folder are no numbers, or none of the two.
PhotoSource photo_source(const std::string& source);

// What two places that look alike are made of, 8-bit grey pictures: what both share, what is there
// in the one and in the other place, and what comes and goes.
struct Ingredients {
  cv::Mat shared;
  cv::Mat own;
  cv::Mat other;
  cv::Mat passing;
};

// Two views of a place, then two of its look-alike, each kMadeView_px: the shared picture, part of
// which, a quarter to three quarters, is another in either place. Where that part lies (blobs,
// panels, or all but the middle, as down a corridor) and how it goes over into the rest is drawn
// anew for each pair of places, and is the same in both, so that no seam tells a look-alike. Each
// view is taken from elsewhere, bent a little for what is near and far, and up to three small
// things come and go. Look-alikes are made, not found: of real ones there are few with a truth
// (mixing pictures to learn from: Yun et al., "CutMix", ICCV 2019).
inline constexpr int kNumMadeViews = 4;
inline const cv::Size kMadeView_px(320, 240);
std::array<cv::Mat, kNumMadeViews> made_views(const Ingredients& ingredients, core::Random& random);

}  // namespace samewhere::pairs
