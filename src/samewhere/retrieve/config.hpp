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
  int views_of_place = 1;
  int lost_candidates = 8;
  int lost_place_frames = 30;

  // sampled search and every_queue only, section 3.1.4 of the published method
  int num_draws = 50;           // L
  double min_similarity = 0.6;  // cosine, eq. (7)
  PerDraw per_draw = PerDraw::kTop3;
  int group_size = 100;
  int queue_size = 10;
};

inline void visit_sampling(Config& config, core::FieldVisitor& visit) {
  visit("num_draws", config.num_draws,
        {.help = "sampled search: L, queues drawn per query", .min = 1, .max = 1000000});
  visit("min_similarity", config.min_similarity,
        {.help = "sampled, every_queue: cosine that a view must exceed, eq. (7)",
         .min = -1.0,
         .max = 1.0});
  visit("per_draw", config.per_draw,
        {.help = "sampled, every_queue: kept of a queue: its three best (Table 1), or the nearest "
                 "by eq. (5)-(6)",
         .choices = {"top3", "nearest"}});
  visit(
      "group_size", config.group_size,
      {.help = "views in a group of the store; a multiple of queue_size", .min = 1, .max = 100000});
  visit("queue_size", config.queue_size,
        {.help = "consecutive views in a queue of the store", .min = 1, .max = 100000});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("search", config.search,
        {.help = "compare every stored view, or a random sample of them (the published method), or "
                 "what the sample tends to with ever more draws",
         .choices = {"exact", "sampled", "every_queue"}});
  visit("num_candidates", config.num_candidates,
        {.help = "views handed to verification, the best ones", .min = 1, .max = 1000});
  visit("word_candidates", config.word_candidates,
        {.help = "and so many more, those that show most of the same features; 0: features are not "
                 "asked",
         .min = 0,
         .max = 1000});
  visit("vocabulary", config.vocabulary,
        {.help = "word_candidates: file of `samewhere train words`; a name alone: of models/, "
                 "or else of the working directory"});
  visit("window_s", config.window_s,
        {.help = "a view this old or younger is no candidate, by the source's frame rate",
         .min = 0.0,
         .max = 1e6});
  visit("window_frames", config.window_frames,
        {.help = "the same in frames, instead of window_s; -1: window_s counts", .min = -1});
  visit("place_frames", config.place_frames,
        {.help = "of views closer than this many frames only the best is a candidate; 0: all are",
         .min = 0});
  visit("shortlist", config.shortlist,
        {.help = "with a map, so many views are grouped into places by what they share of it, and "
                 "num_candidates of them are views of different places; 0: not grouped",
         .min = 0,
         .max = 10000});
  visit("views_of_place", config.views_of_place,
        {.help = "shortlist: so many candidates of one place at most", .min = 1, .max = 1000});
  visit("lost_candidates", config.lost_candidates,
        {.help = "num_candidates for a view that is lost", .min = 1, .max = 1000});
  visit("lost_place_frames", config.lost_place_frames,
        {.help = "place_frames for a view that is lost", .min = 0});
  visit_sampling(config, visit);
}

}  // namespace samewhere::retrieve
