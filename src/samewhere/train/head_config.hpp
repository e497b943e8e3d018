#pragma once

#include <cstdint>

#include <samewhere/core/config.hpp>

namespace samewhere::train {

// What is learnt on the features of a published network (describe.method of the same names).
enum class HeadKind : std::uint8_t { kGem, kNetvlad, kDarknet };

// Settings of one training of a head.
struct HeadConfig {
  int epochs = 20;
  int batch = 40;
  double learning_rate = 3e-4;
  double margin = 0.2;
  int code_size = 256;
  int clusters = 32;
  int seed = 0;
  int threads = 0;
  int twin_step = 5;
  int num_distorted = 1;
};

inline void visit_fields(HeadConfig& config, core::FieldVisitor& visit) {
  visit("epochs", config.epochs, {.help = "passes over all views", .min = 0, .max = 10000});
  visit("batch", config.batch, {.help = "anchors per step", .min = 2, .max = 512});
  visit("learning_rate", config.learning_rate,
        {.help = "of the first epoch; falls along half a cosine", .min = 1e-8, .max = 1.0});
  visit("margin", config.margin, {.help = "of the triplet loss, cosine", .min = 1e-4, .max = 2.0});
  visit("code_size", config.code_size, {.help = "length of the code", .min = 2, .max = 4096});
  visit("clusters", config.clusters, {.help = "of NetVLAD", .min = 2, .max = 256});
  visit("seed", config.seed, {.help = "of everything random", .min = 0});
  visit("threads", config.threads,
        {.help = "0: one per processor; 1: the same bits every time", .min = 0, .max = 64});
  visit("twin_step", config.twin_step,
        {.help = "of a rendered walk (15 frames a second) every so many frames", .min = 1});
  visit("num_distorted", config.num_distorted,
        {.help = "distorted views of an image that is no rendered one", .min = 1, .max = 16});
}

}  // namespace samewhere::train
