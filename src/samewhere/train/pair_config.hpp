#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::train {

// Settings of one training on pairs of views. The program's options are made from the list below.
struct PairConfig {
  int epochs = 30;
  int batch = 32;
  double learning_rate = 2e-3;
  int patience = 10;
  int seed = 0;
  int threads = 1;
  int channels = 16;
  double hidden_pictures = 0.25;
  double hidden_features = 0.0;
  int step = 10;
  int query_step = 10;
  int window_frames = 150;
  int min_matches = 20;
  double other_cameras = 0.7;
};

inline void visit_fields(PairConfig& config, core::FieldVisitor& visit) {
  visit("epochs", config.epochs,
        {.help = "at most so many passes over all pairs", .min = 1, .max = 10000});
  visit("batch", config.batch, {.help = "pairs per step", .min = 2, .max = 1024});
  visit("learning_rate", config.learning_rate,
        {.help = "of the first epoch; falls along half a cosine", .min = 1e-8, .max = 1.0});
  visit("patience", config.patience,
        {.help = "stop after so many epochs without a better validation loss", .min = 1});
  visit("seed", config.seed, {.help = "of everything random", .min = 0});
  visit("threads", config.threads,
        {.help = "0: one per processor; 1: the same bits every time", .min = 0, .max = 64});
  visit("channels", config.channels,
        {.help = "of the first layer; the last has four times as many", .min = 1, .max = 64});
  visit("hidden_pictures", config.hidden_pictures,
        {.help = "share of pairs in training of which only the features are shown; 1: the network "
                 "is blind "
                 "to pictures",
         .min = 0.0,
         .max = 1.0});
  visit(
      "hidden_features", config.hidden_features,
      {.help = "in training, up to this share of the cells of both views shows no features: which "
               "share agrees is to decide, not how many there are",
       .min = 0.0,
       .max = 1.0});
  visit("step", config.step,
        {.help = "every so many frames of a source is a view; of IE Tower each is", .min = 1});
  visit("query_step", config.query_step,
        {.help = "of IE Tower: every so many views is asked for pairs", .min = 1});
  visit("window_frames", config.window_frames,
        {.help = "frames no further apart are no pair", .min = 0});
  visit("other_cameras", config.other_cameras,
        {.help = "share of the views that are made to look as another camera takes them",
         .min = 0.0,
         .max = 1.0});
  visit("min_matches", config.min_matches,
        {.help = "pairs of which fewer matches agree on one geometry are left out", .min = 8});
}

}  // namespace samewhere::train
