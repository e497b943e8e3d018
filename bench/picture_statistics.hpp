#pragma once

#include <array>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace samewhere::bench {

// What tells a photo from a cartoon (too clean, too many corners) or a haze (too few). Grey levels
// run from 0 to 255, pixels are those of the picture given.
struct PictureStatistics {
  double num_fast_corners = 0.0;    // FAST-9 at 20 grey levels, after suppression, not capped
  double fast_spread_ratio = 0.0;   // share of the 16 x 12 grid cells that hold at least one
  double num_orb_features = 0.0;    // of ORB asked for 5000
  double mean_grey = 0.0;           //
  double contrast_grey = 0.0;       // standard deviation
  double dark_ratio = 0.0;          // share of pixels at most 15
  double bright_ratio = 0.0;        // share of pixels at least 240
  double median_gradient = 0.0;     // grey levels per pixel
  double strong_gradient = 0.0;     // its 99th percentile
  double flat_ratio = 0.0;          // share of pixels with less than 2 grey levels per pixel
  double noise_grey = 0.0;          // standard deviation of the noise in the flattest blocks
  double coarse_slope = 0.0;        // alpha of power ~ 1 / frequency^alpha, 64 to 8 pixels a wave
  double fine_slope = 0.0;          // the same, 8 to 3 pixels a wave
  double fine_contrast_grey = 0.0;  // standard deviation left by a Gaussian high pass of 1 pixel
  double colour_saturation = 0.0;   // mean of (max - min) / max over the channels
};

struct PictureFigure {
  std::string_view name;
  double PictureStatistics::*value;
};

inline constexpr std::array<PictureFigure, 15> kPictureFigures = {{
    {"FAST corners", &PictureStatistics::num_fast_corners},
    {"grid cells with a corner", &PictureStatistics::fast_spread_ratio},
    {"ORB features of 5000", &PictureStatistics::num_orb_features},
    {"mean grey", &PictureStatistics::mean_grey},
    {"contrast, grey levels", &PictureStatistics::contrast_grey},
    {"share at most 15", &PictureStatistics::dark_ratio},
    {"share at least 240", &PictureStatistics::bright_ratio},
    {"gradient, median", &PictureStatistics::median_gradient},
    {"gradient, 99th percentile", &PictureStatistics::strong_gradient},
    {"share flatter than 2", &PictureStatistics::flat_ratio},
    {"noise in flat blocks", &PictureStatistics::noise_grey},
    {"spectrum slope, coarse", &PictureStatistics::coarse_slope},
    {"spectrum slope, fine", &PictureStatistics::fine_slope},
    {"fine contrast", &PictureStatistics::fine_contrast_grey},
    {"colour saturation", &PictureStatistics::colour_saturation},
}};

// `image` is 8-bit grey or BGR, each side at least 64 pixels (else ContractError).
PictureStatistics picture_statistics(const cv::Mat& image);

// Standard deviation of the noise: Immerkaer's mask ("Fast noise variance estimation", CVIU 1996),
// which straight edges do not disturb, in the tenth of the 16x16 blocks where it answers least;
// blocks nearer than 16 grey levels to black or white do not count. 0 where there is no other.
double noise_level(const cv::Mat& grey);

// alpha of power ~ 1 / f^alpha between two frequencies (cycles per pixel), by least squares over
// the logarithms of the rings of the spectrum of the middle of the picture, under a Hann window.
// About 2 for photos; less is noise, more is blur. 0 for a picture without any structure.
double spectrum_slope(const cv::Mat& grey, double min_frequency, double max_frequency);

}  // namespace samewhere::bench
