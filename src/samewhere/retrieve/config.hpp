#pragma once

#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::retrieve {

enum class Search { kExact, kSampled, kEveryQueue };
enum class PerDraw { kTop3, kNearest };

struct Config {
  Search search = Search::kExact;
  int num_candidates = 3;
  int word_candidates = 0;
  std::string vocabulary = "words.bin";
  double window_s = 5.0;
  int window_frames = -1;
  int place_frames = 0;
  int shortlist = 30;
  int views_per_place = 1;
  int relocalization_candidates = 8;
  int relocalization_place_frames = 30;

  // sampled search and every_queue only, section 3.1.4 of the published method
  int num_draws = 50;           // L
  double min_similarity = 0.6;  // cosine, eq. (7)
  PerDraw per_draw = PerDraw::kTop3;
  int group_size = 100;
  int queue_size = 10;
};

inline void visit_sampling(Config& config, core::FieldVisitor& visit) {
  visit("num_draws", config.num_draws,
        {.help = "sampled: draws per query, L of the published method", .min = 1, .max = 1000000});
  visit(
      "min_similarity", config.min_similarity,
      {.help = "sampled, every_queue: least cosine similarity, eq. (7)", .min = -1.0, .max = 1.0});
  visit("per_draw", config.per_draw,
        {.help = "sampled, every_queue: views kept of a queue: the best three (Table 1) or the "
                 "nearest, eq. (5)-(6)",
         .choices = {"top3", "nearest"}});
  visit(
      "group_size", config.group_size,
      {.help = "views per group of the store; a multiple of queue_size", .min = 1, .max = 100000});
  visit("queue_size", config.queue_size,
        {.help = "consecutive views per queue of the store", .min = 1, .max = 100000});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("search", config.search,
        {.help = "exact: all views; sampled: random queues (published method); every_queue: the "
                 "limit of sampled for many draws",
         .choices = {"exact", "sampled", "every_queue"}});
  visit("num_candidates", config.num_candidates,
        {.help = "candidates per view, the most similar ones", .min = 1, .max = 1000});
  visit("word_candidates", config.word_candidates,
        {.help = "further candidates, by visual words; 0: none", .min = 0, .max = 1000});
  visit("vocabulary", config.vocabulary,
        {.help = "word_candidates: file of `samewhere train words`, DBoW2 or FBoW; a bare name: in "
                 "models/, else in the working directory"});
  visit("window_s", config.window_s,
        {.help = "views of the last so many seconds are no candidates", .min = 0.0, .max = 1e6});
  visit("window_frames", config.window_frames,
        {.help = "the same in frames, replaces window_s; -1: window_s applies", .min = -1});
  visit("place_frames", config.place_frames,
        {.help = "of the views within so many frames only the most similar is a candidate; 0: off",
         .min = 0});
  visit("shortlist", config.shortlist,
        {.help = "with a map: so many similar views are grouped into places by covisibility, and "
                 "the candidates are of different places; 0: off",
         .min = 0,
         .max = 10000});
  visit("views_per_place", config.views_per_place,
        {.help = "shortlist: largest number of candidates of one place", .min = 1, .max = 1000});
  visit("relocalization_candidates", config.relocalization_candidates,
        {.help = "num_candidates in relocalization", .min = 1, .max = 1000});
  visit("relocalization_place_frames", config.relocalization_place_frames,
        {.help = "place_frames in relocalization", .min = 0});
  visit_sampling(config, visit);
}

}  // namespace samewhere::retrieve
