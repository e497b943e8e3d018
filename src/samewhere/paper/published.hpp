#pragma once

#include <array>

// What the published method reports about itself (docs/paper-map.md, docs/evaluation.md), printed
// beside our figures.
namespace samewhere::paper {

struct PublishedSequence {
  const char* name;
  std::array<double, 7> auc;  // Table 2, L = 10, 20 .. 70
  std::array<double, 7> ms;   // Table 3
  const char* loops;          // Table 6, right/wrong
};

inline constexpr std::array<int, 7> kPublishedNumDraws = {10, 20, 30, 40, 50, 60, 70};

inline constexpr std::array<PublishedSequence, 3> kPublishedSequences = {{
    {"TUM fr3_loh",
     {.5199, .6720, .7613, .7976, .8221, .8356, .8391},
     {41.34, 42.73, 44.49, 47.50, 51.23, 57.71, 64.93},
     "24/12"},
    {"Lip6 Indoor",
     {.4989, .6483, .7637, .7954, .8321, .8449, .8483},
     {39.82, 41.74, 43.38, 46.13, 49.74, 55.95, 63.56},
     "24/9"},
    {"Bicocca Indoor",
     {.5800, .6939, .7700, .8078, .8334, .8423, .8460},
     {40.50, 42.36, 44.36, 47.13, 50.52, 55.30, 64.64},
     "36/9"},
}};

inline constexpr int kPublishedDrawsOfUse = 50;  // L with which the method is used

// Recall and precision that its text names: full precision up to a recall of about .35; at .70
// above .80 on Lip6 and Bicocca, above .75 on fr3_loh.
struct PublishedPoint {
  double recall;
  double precision;
};

inline constexpr std::array<PublishedPoint, 3> kPublishedPoints = {
    {{.35, 1.0}, {.70, .80}, {.70, .75}}};

}  // namespace samewhere::paper
