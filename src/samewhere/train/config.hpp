#pragma once

#include <cstdint>

#include <samewhere/core/config.hpp>

namespace samewhere::train {

// What the autoencoder learns to make of a distorted view.
enum class Target : std::uint8_t { kHog, kPixels };

// Rows x columns of what the encoder sees.
enum class InputSize : std::uint8_t { k120x160, k180x240, k360x480 };

// Settings of one training. The program's options are made from the list below.
struct Config {
  int epochs = 40;
  int batch = 32;
  double learning_rate = 1e-3;
  int patience = 8;
  int seed = 0;
  int threads = 0;
  InputSize input_size = InputSize::k120x160;
  int code_size = 1056;
  int channels = 16;
  Target target = Target::kHog;
  double contrast = 0.3;
  double temperature = 0.07;
  bool pairs = true;
  bool warp = true;
  int twin_step = 5;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("epochs", config.epochs,
        {.help = "at most so many passes over all images", .min = 1, .max = 10000});
  visit("batch", config.batch, {.help = "images per step", .min = 2, .max = 1024});
  visit("learning_rate", config.learning_rate,
        {.help = "of the first epoch; falls along half a cosine", .min = 1e-8, .max = 1.0});
  visit("patience", config.patience,
        {.help = "stop after so many epochs without a better validation loss", .min = 1});
  visit("seed", config.seed, {.help = "of everything random", .min = 0});
  visit("threads", config.threads,
        {.help = "0: one per processor; 1: the same bits every time", .min = 0, .max = 64});
  visit("input_size", config.input_size,
        {.help = "rows x columns of what the encoder sees",
         .choices = {"120x160", "180x240", "360x480"}});
  visit("code_size", config.code_size,
        {.help = "length of the code, a multiple of 24 (4 x 6 positions)",
         .min = 24,
         .max = 24 * 256});
  visit("channels", config.channels,
        {.help = "of the first layer; the others have four times as many", .min = 1, .max = 256});
  visit("target", config.target,
        {.help = "what is reconstructed: HOG of the undistorted view, or its pixels",
         .choices = {"hog", "pixels"}});
  visit("contrast", config.contrast,
        {.help = "weight of the contrastive loss; 0: reconstruction alone",
         .min = 0.0,
         .max = 100.0});
  visit("temperature", config.temperature,
        {.help = "of the contrastive loss: similarities (NCC) are divided by it",
         .min = 0.01,
         .max = 10.0});
  visit(
      "pairs", config.pairs,
      {.help = "contrastive loss: true: of a rendered walk, the second view of a pair is any frame "
               "of the same place; false: the same image"});
  visit("warp", config.warp,
        {.help = "true: the input is seen from another viewpoint; false: it is not"});
  visit("twin_step", config.twin_step,
        {.help = "of a rendered walk (15 frames a second) every so many frames", .min = 1});
}

}  // namespace samewhere::train
