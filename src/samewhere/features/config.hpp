#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::features {

struct Config {
  bool denoise = false;
  bool equalize = false;
  int num_features = 1000;
  int num_levels = 8;
  double scale_factor = 1.2;
  int min_corner_contrast = 7;
  int cell_px = 40;
  double virtual_baseline_m = 0.075;
  int max_distance_bits = 64;
  double max_ratio = 0.8;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("denoise", config.denoise,
        {.help = "median filter of 3 x 3 pixels before corner detection"});
  visit("equalize", config.equalize,
        {.help = "histogram equalization before corner detection, eq. (1)-(4), after `denoise`"});
  visit("num_features", config.num_features,
        {.help = "ORB features per image", .min = 50, .max = 20000});
  visit("num_levels", config.num_levels,
        {.help = "levels of the image pyramid", .min = 1, .max = 12});
  visit("scale_factor", config.scale_factor,
        {.help = "scale between two levels of the pyramid", .min = 1.05, .max = 2.0});
  visit("min_corner_contrast", config.min_corner_contrast,
        {.help = "FAST threshold, grey levels; a low value finds corners on plain walls",
         .min = 1,
         .max = 100});
  visit("cell_px", config.cell_px,
        {.help = "side of the grid cells over which the features are spread evenly, pixels",
         .min = 8,
         .max = 400});
  visit("virtual_baseline_m", config.virtual_baseline_m,
        {.help = "baseline of the virtual stereo pair of a depth camera, metres",
         .min = 0.001,
         .max = 1.0});
  visit("max_distance_bits", config.max_distance_bits,
        {.help = "largest Hamming distance of a match, of 256 bits", .min = 1, .max = 256});
  visit("max_ratio", config.max_ratio,
        {.help = "ratio test: largest ratio of best to second-best distance (Lowe, IJCV 2004)",
         .min = 0.1,
         .max = 1.0});
}

}  // namespace samewhere::features
