#pragma once

#include <array>

// What the published method reports (PLoS ONE, doi 10.1371/journal.pone.0312358, Tables 2 to 8),
// printed beside our figures.
namespace samewhere::paper {

inline constexpr std::array<int, 7> kPublishedNumDraws = {10, 20, 30, 40, 50, 60, 70};
inline constexpr int kPublishedDrawsOfUse = 50;  // L with which the method is used

// A method of Tables 4 and 5: how the tables call it, and its row among ours.
struct PublishedMethod {
  const char* title = "";
  const char* ours = "";  // as --methods has it
};

inline constexpr std::array<PublishedMethod, 7> kPublishedMethods = {{{"published method", "paper"},
                                                                      {"ORB-SLAM2", "words"},
                                                                      {"SqueezeNet", "squeezenet"},
                                                                      {"DarkNet", "darknet"},
                                                                      {"HOG", "hog"},
                                                                      {"GeM", "gem"},
                                                                      {"NetVLAD", "netvlad"}}};

// Table 7, metres.
struct PublishedError {
  double max = 0.0;
  double min = 0.0;
  double median = 0.0;
  double rmse = 0.0;
};

struct PublishedSequence {
  const char* name = "";
  std::array<double, 7> auc_by_draws{};   // Table 2
  std::array<double, 7> ms_by_draws{};    // Table 3
  std::array<double, 7> auc_by_method{};  // Table 4, as kPublishedMethods
  std::array<double, 7> ms_by_method{};   // Table 5
  // Tables 6 to 8: of the published method, of ORB-SLAM2
  std::array<const char*, 2> loops{};  // right/wrong
  std::array<PublishedError, 2> error_m{};
  std::array<double, 2> frames_per_second{};
};

inline constexpr std::array<PublishedSequence, 3> kPublishedSequences = {{
    {"TUM fr3_loh",
     {.5199, .6720, .7613, .7976, .8221, .8356, .8391},
     {41.34, 42.73, 44.49, 47.50, 51.23, 57.71, 64.93},
     {.8221, .6566, .7911, .8020, .7498, .8103, .8074},
     {51.23, 39.98, 56.56, 48.28, 46.13, 50.26, 51.33},
     {"24/12", "20/15"},
     {{{.1352, .0451, .0853, .0887}, {.1504, .0506, .1009, .0952}}},
     {15.52, 14.81}},
    {"Lip6 Indoor",
     {.4989, .6483, .7637, .7954, .8321, .8449, .8483},
     {39.82, 41.74, 43.38, 46.13, 49.74, 55.95, 63.56},
     {.8321, .6428, .7988, .8061, .7562, .8142, .8093},
     {49.74, 38.56, 52.53, 46.11, 44.49, 50.01, 55.69},
     {"24/9", "18/14"},
     {{{.1178, .0347, .0764, .0732}, {.1681, .0517, .1162, .1234}}},
     {16.41, 20.18}},
    {"Bicocca Indoor",
     {.5800, .6939, .7700, .8078, .8334, .8423, .8460},
     {40.50, 42.36, 44.36, 47.13, 50.52, 55.30, 64.64},
     {.8334, .6362, .7993, .8059, .7435, .8195, .8069},
     {50.52, 40.10, 55.05, 48.77, 45.39, 52.17, 53.41},
     {"36/9", "25/16"},
     {{{.1342, .0342, .0791, .0816}, {.1842, .0682, .1234, .1341}}},
     {16.96, 19.62}},
}};

// Recall and precision that its text names: full precision up to a recall of about .35; at .70
// above .80 on Lip6 and Bicocca, above .75 on fr3_loh.
struct PublishedPoint {
  double recall = 0.0;
  double precision = 0.0;
};

inline constexpr std::array<PublishedPoint, 3> kPublishedPoints = {
    {{.35, 1.0}, {.70, .80}, {.70, .75}}};

}  // namespace samewhere::paper
