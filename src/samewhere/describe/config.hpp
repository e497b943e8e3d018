#pragma once

#include <array>
#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::describe {

enum class Method { kHog, kAutoencoder, kSqueezenet, kDarknet, kGem, kNetvlad };

// The names of the methods, in their order.
inline constexpr std::array kMethodNames{"hog",     "autoencoder", "squeezenet",
                                         "darknet", "gem",         "netvlad"};

struct HogConfig {
  int width_px = 160;
  int height_px = 120;
  int cell_px = 20;
  double weak_gradient = 32.0;  // where recognition of warped train_nyu images peaks
};

struct Config {
  Method method = Method::kHog;
  std::string network = "autoencoder.onnx";
  std::string trunks;
  // The published "360x480" read as rows x columns, which keeps the 4:3 of the usual camera.
  int width_px = 480;
  int height_px = 360;
  bool equalize = true;
  HogConfig hog;
};

inline void visit_fields(HogConfig& config, core::FieldVisitor& visit) {
  visit("width_px", config.width_px,
        {.help = "columns of the image; a multiple of cell_px", .min = 2, .max = 4096});
  visit("height_px", config.height_px,
        {.help = "rows of the image; a multiple of cell_px", .min = 2, .max = 4096});
  visit("cell_px", config.cell_px,
        {.help = "side of a cell, pixels; one histogram of orientations each",
         .min = 1,
         .max = 1024});
  visit("weak_gradient", config.weak_gradient,
        {.help = "mean gradient at which a block has weight 0.7, grey levels across two pixels; "
                 "lower gradients have less weight; 0: equal weights",
         .min = 0.0,
         .max = 360.0});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("method", config.method,
        {.help = "histograms of oriented gradients (HOG), the code of a trained network, or a "
                 "published network's features by one of four methods to compare with",
         .choices = {kMethodNames.begin(), kMethodNames.end()}});
  visit("network", config.network,
        {.help = "autoencoder: ONNX file, 1x1xHxW to 1xN, or with a card other inputs; a bare "
                 "name: in models/, else in the working directory"});
  visit("trunks", config.trunks,
        {.help = "squeezenet, darknet, gem, netvlad: folder of the published networks; empty: "
                 "models/, else $SAMEWHERE_DATA/../models",
         .is_expert = true});
  visit("width_px", config.width_px,
        {.help = "columns of the preprocessed image", .min = 1, .max = 4096});
  visit("height_px", config.height_px,
        {.help = "rows of the preprocessed image", .min = 1, .max = 4096});
  visit("equalize", config.equalize, {.help = "histogram equalization, eq. (1)-(4)"});
  visit("hog", config.hog, {.help = "Histograms of oriented gradients"});
}

}  // namespace samewhere::describe
