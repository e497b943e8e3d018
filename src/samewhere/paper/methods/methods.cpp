#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/methods/bowg_method.hpp>
#include <samewhere/paper/methods/fild_method.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/methods/recognition_method.hpp>
#include <samewhere/paper/methods/words_method.hpp>

namespace samewhere::paper {
namespace {

using MakeMethod = std::unique_ptr<Method> (*)(const pipeline::Config& base);

struct KnownMethod {
  MethodInfo info;
  MakeMethod make;
};

constexpr const char* kWordsRan =
    "1000 ORB, vocabulary of retrieve.vocabulary, tf-idf, L1 score; accepted: more than .8 of the "
    "most shared words, score summed over ten neighbours in time (for covisible keyframes), "
    "consistent with three queries before, 20 inliers under a fundamental matrix (for a "
    "similarity transform of a map), pause of ten frames";
constexpr const char* kRerankedRan =
    "the ten best by that score, ranked by inliers under a fundamental matrix; accepted: 20";
constexpr const char* kFildRan =
    "the describer of describe.method (for a ResNet-50), five nearest in a small-world graph of "
    "hnswlib, 1000 ORB (for DELF) with a ratio test of .7, ranked by inliers under a fundamental "
    "matrix; accepted: 20 in two queries in a row (both ours)";
constexpr const char* kBowgRan =
    "580 ORB at five levels (for FAST and BRIEF), words of retrieve.vocabulary .7 and word groups "
    ".3, mixed with the score of the query before, no distribution of features (its published "
    "weight is 0); accepted: score .4, near the island of the query before, 30 inliers under a "
    "fundamental matrix";

pipeline::Config recognition_config(const pipeline::Config& base) {
  pipeline::Config config = pipeline::profile("recognition");
  config.source = base.source;
  config.seed = base.seed;
  config.retrieve.window_frames = base.retrieve.window_frames;
  core::set_config(config, "verify.prior=unique");
  return config;
}

const std::vector<KnownMethod>& registry() {
  static const std::vector<KnownMethod> methods = {
      {{"ours", "samewhere",
        "profile recognition, prior unique: 2000 ORB, HOG and visual words, best of three places, "
        "52 inliers of a view or 40 of two in a row; with the default prior recognition alone "
        "accepts nothing"},
       [](const pipeline::Config& base) {
         return make_recognition_method(recognition_config(base));
       }},
      {{"words", "bag of words (ORB-SLAM2)", kWordsRan}, make_words_method},
      {{"words-geometry", "bag of words + inliers", kRerankedRan}, make_words_geometry_method},
      {{"fild", "FILD++", kFildRan}, make_fild_method},
      {{"bowg", "BoWG", kBowgRan}, make_bowg_method},
  };
  return methods;
}

}  // namespace

const std::vector<MethodInfo>& known_methods() {
  static const std::vector<MethodInfo> infos = [] {
    std::vector<MethodInfo> all;
    for (const KnownMethod& method : registry()) all.push_back(method.info);
    return all;
  }();
  return infos;
}

std::unique_ptr<Method> make_method(const std::string& name, const pipeline::Config& base) {
  std::vector<std::string> names;
  for (const KnownMethod& method : registry()) {
    if (method.info.name == name) return method.make(base);
    names.push_back(method.info.name);
  }
  throw core::InputError(
      fmt::format("there is no method \"{}\", expected one of {}", name, fmt::join(names, ", ")));
}

}  // namespace samewhere::paper
