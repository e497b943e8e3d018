#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/methods/recognition_method.hpp>

namespace samewhere::paper {
namespace {

using MakeMethod = std::unique_ptr<Method> (*)(const pipeline::Config& base);

struct KnownMethod {
  MethodInfo info;
  MakeMethod make;
};

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
